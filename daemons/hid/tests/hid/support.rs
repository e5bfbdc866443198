//! Report descriptors with the layouts of real tablets (decoded bit by bit from them), and reports in them.

use std::collections::BTreeMap;

use maulstick_hid::device_source::Identity;

pub(crate) const DIGITIZER: u16 = 0x0D;
pub(crate) const DESKTOP: u16 = 0x01;
pub(crate) const WACOM: u16 = 0xFF0D;

/// A field of a report: where it is, and what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FieldAt {
    pub(crate) report: u8,
    pub(crate) usage: (u16, u16),
    pub(crate) bit: usize,
    pub(crate) bits: usize,
    pub(crate) range: [i64; 2],
}

/// Writes a descriptor item by item, and keeps its own book of where fields come to lie.
#[derive(Default)]
pub(crate) struct Descriptor {
    pub(crate) bytes: Vec<u8>,
    pub(crate) fields: Vec<FieldAt>,
    ends: BTreeMap<u8, usize>,
    report: u8,
    page: u16,
    usages: Vec<(u16, u16)>,
    range: [i64; 2],
}

impl Descriptor {
    /// An item of the shortest size that holds its value, or of four bytes if the value needs a sign.
    fn item(&mut self, head: u8, value: i64) -> &mut Self {
        let bytes = i32::try_from(value).expect("32 bits").to_le_bytes();
        let (code, length) = match value {
            -128..=127 => (1, 1),
            -32768..=32767 => (2, 2),
            _ => (3, 4),
        };
        self.bytes.push(head | code);
        self.bytes.extend(&bytes[..length]);
        self
    }

    pub(crate) fn page(&mut self, page: u16) -> &mut Self {
        self.page = page;
        self.bytes.push(0x06);
        self.bytes.extend(page.to_le_bytes());
        self
    }

    pub(crate) fn usage(&mut self, usage: u16) -> &mut Self {
        self.usages.push((self.page, usage));
        self.bytes.push(0x0A);
        self.bytes.extend(usage.to_le_bytes());
        self
    }

    pub(crate) fn begin(&mut self, kind: u8) -> &mut Self {
        self.usages.clear();
        self.item(0xA0, i64::from(kind))
    }

    pub(crate) fn end(&mut self) -> &mut Self {
        self.bytes.push(0xC0);
        self
    }

    pub(crate) fn report(&mut self, id: u8) -> &mut Self {
        self.report = id;
        self.bytes.extend([0x85, id]);
        self
    }

    pub(crate) fn range(&mut self, least: i64, most: i64) -> &mut Self {
        self.range = [least, most];
        self.item(0x14, least).item(0x24, most)
    }

    /// From 0 to a greatest value that is written in two bytes, with no room for a sign.
    pub(crate) fn unsigned(&mut self, head: u8, most: u16) -> &mut Self {
        self.range = [0, i64::from(most)];
        self.item(head - 0x10, 0);
        self.bytes.push(head | 2);
        self.bytes.extend(most.to_le_bytes());
        self
    }

    /// Physical range, unit and exponent; all 0 for none.
    pub(crate) fn physical(&mut self, range: [i64; 2], unit: i64, exponent: u8) -> &mut Self {
        self.item(0x34, range[0])
            .item(0x44, range[1])
            .item(0x64, unit)
            .item(0x54, i64::from(exponent))
    }

    /// As many fields as usages were named.
    pub(crate) fn input(&mut self, bits: usize) -> &mut Self {
        let usages = std::mem::take(&mut self.usages);
        let count = i64::try_from(usages.len()).expect("few");
        for usage in usages {
            let bit = self.advance(bits);
            self.fields.push(FieldAt {
                report: self.report,
                usage,
                bit,
                bits,
                range: self.range,
            });
        }
        self.item(0x74, i64::try_from(bits).expect("few"))
            .item(0x94, count)
            .item(0x80, 2)
    }

    pub(crate) fn pad(&mut self, bits: usize) -> &mut Self {
        self.advance(bits);
        self.item(0x74, i64::try_from(bits).expect("few"))
            .item(0x94, 1)
            .item(0x80, 3)
    }

    fn advance(&mut self, bits: usize) -> usize {
        // A report's number comes first.
        let end = self.ends.entry(self.report).or_insert(8);
        *end += bits;
        *end - bits
    }

    pub(crate) fn length(&self, report: u8) -> usize {
        self.ends[&report].div_ceil(8)
    }

    /// The fields of a report.
    pub(crate) fn of(&self, report: u8) -> Vec<FieldAt> {
        let fields = self.fields.iter().copied();
        fields.filter(|field| field.report == report).collect()
    }

    /// A report with these values, all others 0.
    pub(crate) fn pack(&self, report: u8, values: &[((u16, u16), i64)]) -> Vec<u8> {
        let mut bytes = vec![0; self.length(report)];
        bytes[0] = report;
        for field in self.of(report) {
            let found = values.iter().find(|(usage, _)| *usage == field.usage);
            let value = found.map_or(0, |(_, value)| *value);
            for bit in 0..field.bits {
                let at = field.bit + bit;
                bytes[at / 8] |= u8::from(value >> bit & 1 == 1) << (at % 8);
            }
        }
        bytes
    }
}

/// Wacom Intuos Pro M, third generation: report 6 of the standard page, and report 30 of Wacom's own.
pub(crate) fn intuos_pro() -> Descriptor {
    let mut all = Descriptor::default();
    all.page(DIGITIZER).usage(0x02).begin(1).report(6);
    all.usage(0x20).begin(0).pad(8).range(0, 1);
    all.usage(0x42).usage(0x44).usage(0x5A).input(1).pad(1);
    all.usage(0x45).usage(0x3C).usage(0x32).input(1).pad(1);
    all.page(DESKTOP).usage(0x30).range(0, 26_300);
    all.physical([0, 26_300], 0x11, 0x0D).input(16);
    all.usage(0x31).range(0, 14_800);
    all.physical([0, 14_800], 0x11, 0x0D).input(16);
    all.page(DIGITIZER).usage(0x30).range(0, 4095);
    all.physical([0, 0], 0, 0).input(16);
    all.usage(0x3D).usage(0x3E).range(-9000, 9000);
    all.physical([-9000, 9000], 0x14, 0x0E).input(16);
    all.page(DESKTOP).usage(0x32).range(0, 63);
    all.physical([0, 0], 0, 0).input(8).end().end();

    all.page(WACOM).usage(0x01).begin(1).report(30);
    all.usage(0x20).begin(0).pad(8).range(0, 1);
    all.usage(0x42).usage(0x44).usage(0x5A).input(1).pad(1);
    all.usage(0x45).usage(0x3C).usage(0x32).usage(0x36).input(1);
    all.usage(0x130).range(0, 52_600);
    all.physical([0, 26_300], 0x11, 0x0D).input(24);
    all.usage(0x131).range(0, 29_600);
    all.physical([0, 14_800], 0x11, 0x0D).input(24);
    all.usage(0x30).range(0, 8191);
    all.physical([0, 0], 0, 0).input(16);
    all.usage(0x3D).usage(0x3E).range(-90, 90).input(16);
    all.usage(0x41).range(-900, 899);
    all.physical([-180, 179], 0x14, 0).input(16);
    all.usage(0xD03).range(0, 2047);
    all.physical([0, 0], 0, 0).input(16);
    all.usage(0x132).range(0, 63).input(8);
    all.usage(0x5B).usage(0x5C).range(0, 0x7FFF_FFFF).input(32);
    all.usage(0x77).range(0, 0x7FFF).input(16).end().end();
    all
}

/// Wacom Intuos S.
pub(crate) fn intuos_s() -> Descriptor {
    let mut all = Descriptor::default();
    all.page(WACOM).usage(0x01).begin(1).report(16);
    all.usage(0x20).begin(0).range(0, 1);
    all.usage(0x42).usage(0x44).usage(0x5A).input(1).pad(2);
    all.usage(0x32).usage(0x36).input(1).pad(1);
    all.usage(0x130).range(0, 15_200);
    all.physical([0, 15_200], 0x11, 0x0D).input(24);
    all.usage(0x131).range(0, 9500);
    all.physical([0, 9500], 0x11, 0x0D).input(24);
    all.usage(0x30).range(0, 4095);
    all.physical([0, 0], 0, 0).input(16).pad(48);
    all.usage(0x132).range(0, 63).input(8);
    all.usage(0x5B).range(0, 0x7FFF_FFFF).input(32).end().end();
    all
}

/// XP-Pen Deco L.
pub(crate) fn deco_l() -> Descriptor {
    let mut all = Descriptor::default();
    all.page(DIGITIZER).usage(0x02).begin(1).report(2);
    all.usage(0x20).begin(0).range(0, 1);
    all.usage(0x42).usage(0x44).usage(0x46).input(1).pad(2);
    all.usage(0x32).input(1).pad(2);
    all.page(DESKTOP).usage(0x30).range(0, 50_800);
    all.physical([0, 10_000], 0x13, 0x0D).input(16);
    all.usage(0x31).range(0, 30_480);
    all.physical([0, 6000], 0x13, 0x0D).input(16);
    all.page(DIGITIZER).usage(0x30).range(0, 8191);
    all.physical([0, 0], 0, 0).input(13).pad(3);
    all.usage(0x3D).usage(0x3E).range(-60, 60);
    all.physical([-60, 60], 0x14, 0).input(8).end().end();
    all
}

/// A pen that says how it leans by azimuth and altitude, and how it is twisted by no unit, on a tablet that says nothing of lengths.
pub(crate) fn azimuths() -> Descriptor {
    let mut all = Descriptor::default();
    all.page(DIGITIZER)
        .usage(0x02)
        .begin(1)
        .report(1)
        .range(0, 1);
    all.usage(0x42).usage(0x32).input(1).pad(6);
    all.page(DESKTOP).usage(0x30).range(0, 40_000).input(16);
    all.usage(0x31).range(0, 20_000).input(16);
    all.page(DIGITIZER).usage(0x3F).range(0, 3600);
    all.physical([0, 3600], 0x14, 0x0F).input(16);
    all.usage(0x40).range(0, 900);
    all.physical([0, 900], 0x14, 0x0F).input(16);
    all.usage(0x41).range(0, 1000);
    all.physical([0, 0], 0, 0).input(16).end();
    all
}

/// Three buttons and two relative axes in a collection of any page and usage.
pub(crate) fn pointer(page: u16, usage: u16) -> Descriptor {
    let mut all = Descriptor::default();
    all.page(page).usage(usage).begin(1).report(1).range(0, 1);
    all.page(0x09).usage(1).usage(2).usage(3).input(1).pad(5);
    all.page(DESKTOP).usage(0x30).usage(0x31).range(-127, 127);
    all.input(8).end();
    all
}

/// A SpaceMouse: three pushes in report 1, three turns in report 2, buttons in report 3.
pub(crate) fn spacemouse() -> Descriptor {
    let mut all = Descriptor::default();
    all.page(DESKTOP)
        .usage(0x08)
        .begin(1)
        .report(1)
        .range(-350, 350);
    all.usage(0x30).usage(0x31).usage(0x32).input(16).report(2);
    all.usage(0x33).usage(0x34).usage(0x35).input(16).report(3);
    all.page(0x09)
        .usage(1)
        .usage(2)
        .range(0, 1)
        .input(1)
        .pad(14)
        .end();
    all
}

pub(crate) fn identity(vendor: u16, product: u16, name: &str) -> Identity {
    Identity {
        bus: 3,
        vendor,
        product,
        name: name.into(),
        place: "/dev/hidraw3".into(),
    }
}
