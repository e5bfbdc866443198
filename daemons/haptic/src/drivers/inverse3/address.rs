//! Address of an Inverse3: `ws://host:port#device+grip`, each part of which may be left out.

use maulstick_rig::UserError;

/// Default URL of the service, of version 3.1 and later.
pub const DEFAULT_URL: &str = "ws://localhost:10001";

/// Parsed `address` of a section.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    /// The service's URL.
    pub url: String,
    /// ServoThread and port to connect to.
    pub host: String,
    /// The Inverse3's id; the only one if absent.
    pub device: Option<String>,
    /// The id of the VerseGrip that is held with it; the first if absent.
    pub grip: Option<String>,
}

impl Address {
    /// Reads an `address`.
    ///
    /// # Errors
    /// A [`UserError`] if it is invalid.
    pub fn read(address: Option<&str>) -> Result<Self, UserError> {
        let text = address.unwrap_or_default();
        let wrong = || {
            UserError::usage(format!("address = {text:?} is no Inverse3's")).help(format!(
                "write {DEFAULT_URL}, and with several devices {DEFAULT_URL}#device or \
                 {DEFAULT_URL}#device+grip with their ids"
            ))
        };
        let (url, ids) = text.split_once('#').unwrap_or((text, ""));
        let url = match url.trim_end_matches('/') {
            "" => DEFAULT_URL,
            url => url,
        };
        let host = url.strip_prefix("ws://").ok_or_else(wrong)?;
        let port = host.rsplit_once(':').and_then(|(name, port)| {
            let port: u16 = port.parse().ok()?;
            (!name.is_empty() && port > 0).then_some(port)
        });
        if port.is_none() || host.contains(['/', '?', ' ', '@']) {
            return Err(wrong());
        }
        let (device, grip) = ids.split_once('+').unwrap_or((ids, ""));
        let named = |id: &str| (!id.is_empty()).then(|| id.to_owned());
        Ok(Self {
            url: url.to_owned(),
            host: host.to_owned(),
            device: named(device),
            grip: named(grip),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (String, Option<String>, Option<String>) {
        let address = Address::read(Some(text)).expect("an address");
        (address.host, address.device, address.grip)
    }

    #[test]
    fn each_part_of_an_address_may_be_left_out() {
        let here = "localhost:10001".to_owned();
        let id = |text: &str| Some(text.to_owned());
        assert_eq!(Address::read(None).expect("default").url, DEFAULT_URL);
        assert_eq!(read(""), (here.clone(), None, None));
        assert_eq!(read("#049D"), (here.clone(), id("049D"), None));
        assert_eq!(read("#049D+61548"), (here.clone(), id("049D"), id("61548")));
        assert_eq!(read("#+61548"), (here, None, id("61548")));
        let there = "studio:10000".to_owned();
        assert_eq!(
            read("ws://studio:10000/#049D"),
            (there.clone(), id("049D"), None)
        );
        assert_eq!(read("ws://studio:10000"), (there, None, None));
    }

    #[test]
    fn what_is_no_address_is_told_how_one_looks() {
        for text in [
            "localhost:10001",
            "http://localhost:10001",
            "ws://localhost",
            "ws://:10001",
            "ws://localhost:0",
            "ws://localhost:99999",
            "ws://localhost:10001/simulation",
            "/dev/ttyACM0",
        ] {
            let fault = Address::read(Some(text)).expect_err(text);
            assert!(fault.what.contains(text) && fault.help.is_some_and(|h| h.contains("ws://")));
        }
    }
}
