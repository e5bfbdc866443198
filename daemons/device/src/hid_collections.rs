//! Kind of a HID device by its own description: the application collections of its report descriptor (Device Class
//! Definition for HID 1.11, § 6.2.2). Fields and reports are read elsewhere.

/// An application collection: a pen, a keyboard, a multi-axis controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Collection {
    /// Usage page.
    pub page: u16,
    /// Usage.
    pub usage: u16,
}

/// The page of digitizers; Wacom's own page has the same usages.
const DIGITIZERS: [u16; 2] = [0x0d, 0xff0d];
/// Digitizer and pen.
const PENS: [u16; 2] = [0x01, 0x02];
/// Generic desktop, multi-axis controller.
const SIX_AXES: Collection = Collection {
    page: 0x01,
    usage: 0x08,
};

impl Collection {
    /// True for a pen's collection.
    #[must_use]
    pub fn is_pen(&self) -> bool {
        DIGITIZERS.contains(&self.page) && PENS.contains(&self.usage)
    }

    /// True for a 6-DOF mouse's collection.
    #[must_use]
    pub fn has_six_axes(&self) -> bool {
        *self == SIX_AXES
    }
}

/// Prefix of a long item.
const LONG: u8 = 0xfe;
/// Prefixes of short items without their sizes.
const USAGE_PAGE: u8 = 0x04;
const USAGE: u8 = 0x08;
const COLLECTION: u8 = 0xa0;
const PUSH: u8 = 0xa4;
const POP: u8 = 0xb4;
/// The kind of collection that is an application.
const APPLICATION: u32 = 1;

/// The application collections of a report descriptor, in their order. A descriptor that breaks off
/// has those before the break.
#[must_use]
pub fn collections(descriptor: &[u8]) -> Vec<Collection> {
    let mut found = Vec::new();
    let (mut page, mut pushed) = (0, Vec::new());
    let mut usage: Option<Usage> = None;
    let mut rest = descriptor;
    while let Some((prefix, data, after)) = item(rest) {
        rest = after;
        match prefix & 0xfc {
            USAGE_PAGE => page = data as u16,
            PUSH => pushed.push(page),
            POP => page = pushed.pop().unwrap_or(page),
            USAGE => {
                let named = match prefix & 3 {
                    3 => Usage::Whole(data),
                    _ => Usage::OfPage(data as u16),
                };
                usage = usage.or(Some(named));
            }
            COLLECTION if data == APPLICATION => found.push(match usage {
                Some(Usage::Whole(both)) => Collection {
                    page: (both >> 16) as u16,
                    usage: both as u16,
                },
                Some(Usage::OfPage(usage)) => Collection { page, usage },
                None => Collection { page, usage: 0 },
            }),
            _ => {}
        }
        // Local items hold until the next main item.
        if prefix & 0x0c == 0 {
            usage = None;
        }
    }
    found
}

/// A usage as it is written.
#[derive(Clone, Copy)]
enum Usage {
    /// With its page in the upper half.
    Whole(u32),
    /// Of the page that holds at the main item.
    OfPage(u16),
}

/// The first short item: its prefix, its data, and what comes after it; long items are passed over.
fn item(mut bytes: &[u8]) -> Option<(u8, u32, &[u8])> {
    loop {
        let (&prefix, rest) = bytes.split_first()?;
        if prefix == LONG {
            let (&length, rest) = rest.split_first()?;
            // A tag, then the data.
            bytes = rest.get(1 + usize::from(length)..)?;
            continue;
        }
        let length = [0, 1, 2, 4][usize::from(prefix & 3)];
        let data = rest.get(..length)?;
        let number = |sum: u32, byte: &u8| sum << 8 | u32::from(*byte);
        return Some((prefix, data.iter().rev().fold(0, number), &rest[length..]));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const fn of(page: u16, usage: u16) -> Collection {
        Collection { page, usage }
    }

    #[test]
    fn a_pen_with_its_pad_a_keyboard_and_a_6_dof_mouse_are_told_apart() {
        // A pen whose stylus is a physical collection inside, then Wacom's own page.
        let pen = [
            0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0x85, 0x06, 0x09, 0x20, 0xa1, 0x00, 0x75, 0x01,
            0x95, 0x01, 0x81, 0x02, 0xc0, 0xc0, 0x06, 0x0d, 0xff, 0x09, 0x01, 0xa1, 0x01, 0xc0,
        ];
        assert_eq!(collections(&pen), [of(0x0d, 0x02), of(0xff0d, 0x01)]);
        assert!(collections(&pen).iter().all(Collection::is_pen));
        let keyboard = [0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0xc0];
        assert_eq!(collections(&keyboard), [of(0x01, 0x06)]);
        assert!(!of(0x01, 0x06).is_pen() && !of(0x01, 0x06).has_six_axes());
        let mouse = [0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0xc0];
        assert!(collections(&mouse)[0].has_six_axes());
        // A touch screen is no pen.
        assert!(!of(0x0d, 0x04).is_pen());
    }

    #[test]
    fn the_page_is_that_which_holds_at_the_collection() {
        // The page comes after the usage; a usage of four bytes has its own; push and pop.
        assert_eq!(
            collections(&[0x09, 0x02, 0x05, 0x0d, 0xa1, 0x01]),
            [of(0x0d, 0x02)]
        );
        assert_eq!(
            collections(&[0x05, 0x01, 0x0b, 0x02, 0x00, 0x0d, 0x00, 0xa1, 0x01]),
            [of(0x0d, 0x02)]
        );
        assert_eq!(
            collections(&[0x05, 0x0d, 0xa4, 0x05, 0x01, 0xb4, 0x09, 0x02, 0xa1, 0x01]),
            [of(0x0d, 0x02)]
        );
        // The usage of a field is none of the collection after it.
        assert_eq!(
            collections(&[0x05, 0x0d, 0x09, 0x02, 0x81, 0x02, 0xa1, 0x01]),
            [of(0x0d, 0)]
        );
    }

    /// A descriptor of collections, each with fields and a long item in it.
    fn written(wanted: &[(Collection, bool)], noise: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (collection, is_application) in wanted {
            bytes.push(0x06);
            bytes.extend(collection.page.to_le_bytes());
            bytes.push(0x0a);
            bytes.extend(collection.usage.to_le_bytes());
            bytes.extend([0xa1, u8::from(*is_application)]);
            bytes.extend([LONG, noise.len() as u8, 0xf0]);
            bytes.extend(noise);
            bytes.extend([0x09, 0x30, 0x15, 0x00, 0x26, 0xff, 0x7f, 0x81, 0x02, 0xc0]);
        }
        bytes
    }

    proptest! {
        #[test]
        fn what_is_written_is_read(
            wanted in proptest::collection::vec((any::<(u16, u16)>(), any::<bool>()), 0..6),
            noise in proptest::collection::vec(any::<u8>(), 0..200),
        ) {
            let wanted: Vec<(Collection, bool)> =
                wanted.into_iter().map(|((page, usage), is)| (of(page, usage), is)).collect();
            let expected: Vec<Collection> =
                wanted.iter().filter(|(_, is)| *is).map(|(one, _)| *one).collect();
            let bytes = written(&wanted, &noise);
            prop_assert_eq!(collections(&bytes), expected.clone());
            // The seeded fault: one collection of another kind would show.
            if let Some(place) = wanted.iter().position(|(_, is)| *is) {
                let mut other = wanted.clone();
                other[place].1 = false;
                prop_assert_ne!(collections(&written(&other, &noise)), expected);
            }
        }

        #[test]
        fn no_bytes_make_the_collections_panic_or_be_more_than_are_there(
            bytes in proptest::collection::vec(any::<u8>(), 0..64),
        ) {
            // An application collection takes two bytes at least.
            prop_assert!(collections(&bytes).len() <= bytes.len() / 2);
        }
    }
}
