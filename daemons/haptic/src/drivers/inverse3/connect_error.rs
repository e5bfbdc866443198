//! Errors of connecting to an Inverse3.

use maulstick_rig::UserError;

use super::message::Hindrance;

/// The reason why no Inverse3 is connected to at a service.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConnectError {
    /// The service's URL.
    pub url: String,
    /// The reason.
    pub refusal: Refusal,
}

/// What a service or its device lacks. Devices and grips are called by their ids.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// Nothing answers; why not.
    NoService(String),
    /// Another program answers; why it is no service.
    Foreign(String),
    /// The service sees no device.
    Absent,
    /// It sees others than this one.
    NoDevice(String, Vec<String>),
    /// It sees several, and none is named.
    Several(Vec<String>),
    /// It sees other grips than this one.
    NoGrip(String, Vec<String>),
    /// Another program has the device.
    InUse(String),
    /// The device is not ready.
    Hindered(String, Hindrance),
    /// The system gives no thread; why not.
    NoThread(String),
}

impl ConnectError {
    pub(crate) fn new(url: &str, refusal: Refusal) -> Self {
        let url = url.to_owned();
        Self { url, refusal }
    }
}

impl From<ConnectError> for UserError {
    fn from(ConnectError { url, refusal }: ConnectError) -> Self {
        let (what, help) = match refusal {
            Refusal::NoService(why) => (
                format!("no Inverse service answers at {url}: {why}"),
                "start it by `systemctl start haply-inverse-service`, or install it from docs.haply.co; \
                 old ones listen at ws://localhost:10000, which is to be the device's `address` then"
                    .to_owned(),
            ),
            Refusal::Foreign(why) => (
                format!("what answers at {url} is no Inverse service: {why}"),
                "name the service's own as the device's `address`".to_owned(),
            ),
            Refusal::Absent => (
                format!("the Inverse service at {url} sees no Inverse3"),
                "plug it in and switch it on, and look whether Haply Hub sees it".to_owned(),
            ),
            Refusal::NoDevice(id, others) => (
                format!("the Inverse service at {url} sees no Inverse3 {id}"),
                format!("switch it on; there are: {}", others.join(", ")),
            ),
            Refusal::Several(ids) => (
                format!(
                    "the Inverse service at {url} sees several Inverse3s: {}",
                    ids.join(", ")
                ),
                format!("name one as the device's `address`: {url}#id"),
            ),
            Refusal::NoGrip(id, others) => (
                format!("the Inverse service at {url} sees no VerseGrip {id}"),
                if others.is_empty() {
                    "switch it on, or leave it out of `address`".to_owned()
                } else {
                    format!("switch it on; there are: {}", others.join(", "))
                },
            ),
            Refusal::InUse(id) => (
                format!("the Inverse3 {id} at {url} is in use by another program"),
                "end the other program".to_owned(),
            ),
            Refusal::Hindered(id, hindrance) => (
                format!("{} ({id} at {url})", hindrance.what()),
                hindrance.help().to_owned(),
            ),
            Refusal::NoThread(why) => {
                return Self::failure(format!("no thread for the Inverse3: {why}"));
            }
        };
        Self::failure(what).help(help)
    }
}
