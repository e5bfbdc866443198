//! The bytes of a header, as documented.

#[test]
fn a_header_has_the_documented_bytes() {
    let bytes: Vec<u8> = {
        let hex = include_str!("golden.txt")
            .lines()
            .next()
            .and_then(|l| l.split(' ').nth(2));
        let hex = hex.expect("a line");
        (0..hex.len())
            .step_by(2)
            .map(|at| u8::from_str_radix(&hex[at..at + 2], 16).expect("hex"))
            .collect()
    };
    assert_eq!(&bytes[..4], &[0x4c, 0x4d, 1, 0], "magic and version");
    assert_eq!(
        &bytes[8..20],
        &[4, 3, 2, 1, 8, 7, 6, 5, 3, 0, 0, 0],
        "source, epoch, flags"
    );
    assert_eq!(
        &bytes[24..48],
        &[
            11, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 0, 0, 0, 0, 0, 13, 0, 0, 0, 0, 0, 0, 0
        ]
    );
}
