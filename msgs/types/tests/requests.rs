//! Requests whose command is out of range.

use maulstick_types::command::{CommandRequest, RigCommand};
use maulstick_types::values::DeviceName;
use maulstick_types::{Flags, Origin, decode, encode};

#[test]
fn a_request_out_of_range_still_has_its_number() {
    let origin = Origin {
        source: 1,
        epoch: 2,
    };
    let name = DeviceName::new("arm").expect("a name");
    let request = CommandRequest {
        client: 1,
        number: 2,
        after: None,
        command: RigCommand::RemoveDevice { name }.into(),
    };
    let mut bytes = encode(&origin, Flags::NONE, 3, 4, 5, &request).expect("short");
    assert_eq!(CommandRequest::number_in(&bytes), Some(2));
    assert!(decode::<CommandRequest>(&bytes).is_ok());
    // The name ends the message, and holds no line breaks.
    *bytes.last_mut().expect("not empty") = b'\n';
    assert!(decode::<CommandRequest>(&bytes).is_err());
    assert_eq!(CommandRequest::number_in(&bytes), Some(2));
}
