use proptest::prelude::*;

use super::*;

fn imported(text: &str) -> Result<Imported, UserError> {
    parse(text, "strokes.dat", TableLayout::default(), "table")
}

fn read(text: &str) -> Result<Take, UserError> {
    imported(text).map(|imported| imported.take)
}

fn fault(text: &str) -> String {
    read(text).expect_err(text).to_string()
}

#[test]
fn the_middle_is_the_origin_and_y_is_flipped() {
    let take = read("5.0 512 512 0\n5.008 516 508 0.5\n").expect("a take");
    assert_eq!(take.samples[1].time_ns, 8_000_000);
    let point = |i: usize| match take.samples[i].sample.pose {
        StylusPose::Contact { point_m, .. } => point_m,
        StylusPose::Ferrule { .. } => panic!("a pen"),
    };
    assert_eq!(point(0), [0.0; 3]);
    assert!((point(1)[0] - 1e-3).abs() < 1e-15 && (point(1)[1] - 1e-3).abs() < 1e-15);
}

#[test]
fn tilt_twist_commas_and_headers_are_read() {
    let take = read("# by hand\npressure,t,x,y,tilt_x,tilt_y\n0.5,0,1,2,10,20\n").expect("one");
    match &take.samples[0].sample.pose {
        StylusPose::Contact {
            tilt_rad, pressure, ..
        } => {
            assert_eq!(*pressure, 0.5);
            assert!((tilt_rad[0].to_degrees() - 10.0).abs() < 1e-9);
            assert!((tilt_rad[1].to_degrees() + 20.0).abs() < 1e-9);
        }
        StylusPose::Ferrule { .. } => panic!("a pen"),
    }
    assert_ne!(take.samples[0].sample.senses & axes::TILT, 0);
}

#[test]
fn bad_tables_name_line_and_column() {
    let good = "0 1 1 0\n";
    let text = fault(&format!("{good}0.1 1 1\n"));
    assert!(
        text.contains("strokes.dat:2") && text.contains("3 columns"),
        "{text}"
    );
    let text = fault("t,x,y,pressure\n0,1,1,\n");
    assert!(
        text.contains("strokes.dat:2") && text.contains("(pressure)"),
        "{text}"
    );
    let text = fault(&format!("{good}0.1 one 1 0\n"));
    assert!(
        text.contains("column 2") && text.contains("'one'"),
        "{text}"
    );
    for (text, place, data) in [
        (
            &format!("{good}0.1 1 1 NaN\n")[..],
            "strokes.dat:2",
            "'NaN'",
        ),
        (&format!("{good}-1 1 1 0\n"), "strokes.dat:2", "-1"),
        ("0 1 1 1.5\n", "strokes.dat:1", "1.5"),
        ("0 1 1 1 91 0\n", "strokes.dat:1", "tilt_x"),
        ("t x y presure\n0 1 1 1\n", "strokes.dat:1", "'pressure'"),
        ("# nothing\n", "strokes.dat", ""),
    ] {
        let fault = read(text).expect_err(text);
        assert_eq!(fault.place.as_deref(), Some(place), "{text}");
        assert!(fault.to_string().contains(data), "{fault}");
    }
}

/// Twenty samples of a stroke, `step` apart.
fn stroke(step: f64) -> String {
    let row = |i: u32| format!("{} {} 512 0.5\n", step * f64::from(i), 400 + i);
    (0..20).map(row).collect()
}

#[test]
fn a_byte_order_mark_is_passed_over() {
    assert_eq!(
        read("\u{feff}0 1 1 0\n0.1 3 3 0\n")
            .expect("a take")
            .samples
            .len(),
        2
    );
    assert!(read("\u{feff}t,x,y,pressure\n0,1,1,0\n").is_ok());
}

#[test]
fn a_unit_of_time_is_guessed_only_where_it_is_safe() {
    use TimeUnit::{Ms, Ns, Us};
    for (step, unit) in [(8.0, Ms), (16.7, Ms), (8000.0, Us), (8e6, Ns)] {
        let imported = imported(&stroke(step)).expect("a take");
        assert!(
            matches!(imported.notes[..], [Note::Unit { unit: taken, .. }] if taken == unit),
            "{step}: {:?}",
            imported.notes
        );
        let period = imported.take.samples[1].time_ns;
        assert!(
            (5_000_000..20_000_000).contains(&period),
            "{step}: {period}"
        );
    }
    assert!(imported(&stroke(0.008)).expect("seconds").notes.is_empty());
    // An index, or a second a sample; a polyline by hand; 5 Hz.
    for step in [1.0, 0.2, 0.15, 500.0, 1e4 * 15.0] {
        let said = fault(&stroke(step));
        assert!(
            said.contains("apart") && said.contains("--time-unit"),
            "{step}: {said}"
        );
    }
    let layout = TableLayout {
        time_unit: Some(TimeUnit::Ms),
        ..TableLayout::default()
    };
    let read = |step| parse(&stroke(step), "a", layout, "table");
    assert_eq!(
        read(1.0).expect("a take").take.samples[1].time_ns,
        1_000_000
    );
    assert!(read(200.0).is_err());
}

#[test]
fn raw_tablet_units_are_refused_with_the_options_that_fit() {
    let said = fault("0 100 100 0.5\n0.008 44000 27900.2 0.5\n");
    for part in ["strokes.dat:2", "10 m", "--size 44000x27901", "--unit-mm"] {
        assert!(said.contains(part), "{said}");
    }
    let near = imported("0 100 100 0.5\n0.008 2000 900 0.5\n").expect("near");
    let outside = Note::Outside {
        beyond: 1,
        samples: 2,
        size: [1024.0; 2],
    };
    assert_eq!(near.notes[0], outside);
}

#[test]
fn what_paints_nothing_is_said() {
    let gap = format!("{}1 420 512 0.5\n1.008 421 512 0.5\n", stroke(0.008));
    let notes = imported(&gap).expect("a take").notes;
    let torn = Note::Torn {
        line: 21,
        places: 1,
    };
    assert_eq!(notes[0], torn);
    let notes = imported("0 1 1 0\n0.1 2 2 0\n").expect("a take").notes;
    assert_eq!(notes[0], Note::Unpainted);
    // The pen is lifted in between.
    let lifted = format!("{}0.2 420 512 0\n1 420 512 0.5\n", stroke(0.008));
    assert!(imported(&lifted).expect("a take").notes.is_empty());
}

/// Times, s, pressures and x, in table units, of an imported table.
fn samples(text: &str) -> Vec<(f64, f64, f64)> {
    let take = read(text).expect(text);
    let sample = |sample: &TakeSample| match sample.sample.pose {
        StylusPose::Contact {
            point_m, pressure, ..
        } => (
            sample.time_ns as f64 * 1e-9,
            pressure,
            point_m[0] / 0.25e-3 + 512.0,
        ),
        StylusPose::Ferrule { .. } => panic!("a pen"),
    };
    take.samples.iter().map(sample).collect()
}

#[test]
fn spreadsheets_of_any_country_give_the_same_take() {
    let plain = "t,x,y,pressure\n0.000,300,512,0.5\n0.008,304.25,512,0.75\n";
    let take = read(plain).expect("a take");
    assert_eq!(take.samples.len(), 2);
    for text in [
        "t;x;y;pressure\n0,000;300;512;0,5\n0,008;304,25;512;0,75\n",
        "\"t\",\"x\",\"Y\",\"Pressure\"\r\n0.000,300,512,0.5\r\n0.008,304.25,512,0.75\r\n",
        "\u{feff}T\tx\ty\tpressure\r0.000\t300\t512\t0.5\r0.008\t304.25\t512\t0.75\r",
        "\"0,000\",\"300\",\"512\",\"0,5\"\n\"0,008\",\"304,25\",\"512\",\"0,75\"\n",
    ] {
        assert_eq!(read(text).expect(text), take, "{text:?}");
    }
    let whole = imported("t;x;y;pressure\n0;300;500;0,20\n8;304;500;0,50\n").expect("a take");
    assert_eq!(whole.take.samples[1].time_ns, 8_000_000);
}

#[test]
fn strokes_are_parted_with_the_pen_lifted_between() {
    let apart = [
        "0.000 300 300 0.6\n0.008 304 300 0.6\n\n0.016 600 700 0.6\n0.024 604 700 0.6\n",
        "t,x,y,pressure\n0,300,300,.6\n.008,304,300,.6\n0,600,700,.6\n.008,604,700,.6\n",
        "t,x,y,pressure,stroke\n0,300,300,.6,a\n.008,304,300,.6,a\n0.016,600,700,.6,b\n0.024,604,700,.6,b\n",
        "t,x,y,pressure,stroke\n0,300,300,.6,1\n.008,304,300,.6,1\n\n-5,600,700,.6,1\n-4.992,604,700,.6,1\n",
    ];
    for text in apart {
        let found = samples(text);
        let pressures: Vec<f64> = found.iter().map(|sample| sample.1).collect();
        assert_eq!(pressures, [0.6, 0.6, 0.0, 0.0, 0.6, 0.6], "{text}");
        let places: Vec<f64> = found.iter().map(|sample| sample.2.round()).collect();
        assert_eq!(places, [300.0, 304.0, 304.0, 600.0, 600.0, 604.0], "{text}");
        let pause = found[4].0 - found[1].0;
        assert!((pause - 0.2).abs() < 1e-9, "{text}: {pause}");
        assert!(found.is_sorted_by(|one, other| one.0 < other.0), "{text}");
        let notes = imported(text).expect("a take").notes;
        assert!(notes.contains(&Note::Strokes(2)), "{notes:?}");
    }
    // A pause of the table's own stays, and so does a pen that was lifted.
    let own = samples("0 300 300 .6\n.008 304 300 0\n\n1 600 700 0\n1.008 604 700 .6\n");
    assert_eq!(own.len(), 4);
    assert!((own[2].0 - 1.0).abs() < 1e-9, "{own:?}");
    // One number for all strokes is one stroke, and line ends written twice part nothing.
    for text in [
        "t,x,y,pressure,stroke\n0,1,1,.6,1\n.008,2,1,.6,1\n",
        "0 1 1 .6\r\r\n.008 2 1 .6\r\r\n.016 3 1 .6\r\r\n",
    ] {
        assert!(imported(text).expect("a take").notes.is_empty(), "{text}");
    }
}

#[test]
fn time_that_falls_back_within_a_stroke_is_refused() {
    let line = |text: &str| {
        let fault = read(text).expect_err(text);
        fault.place.expect("a place")
    };
    // Out of order; the newest first.
    assert_eq!(line("0 1 1 .5\n.01 1 1 .5\n.005 1 1 .5\n"), "strokes.dat:3");
    assert_eq!(line(".02 1 1 .5\n.01 1 1 .5\n0 1 1 .5\n"), "strokes.dat:2");
    assert_eq!(
        line("0 1 1 .5\n.01 1 1 .5\n0 1 1 .5\n-.01 1 1 .5\n"),
        "strokes.dat:4"
    );
}

#[test]
fn samples_of_one_time_are_spread_and_none_is_lost() {
    let coarse: String = (0..200)
        .map(|i| format!("{:.2},{},512,0.5\n", f64::from(i / 10) * 0.1, 200 + 3 * i))
        .collect();
    let found = samples(&format!("t,x,y,pressure\n{coarse}"));
    assert_eq!(found.len(), 200);
    for (i, (time, ..)) in (0..).zip(&found) {
        assert!((time - 0.01 * f64::from(i)).abs() < 1e-9, "{i}: {time}");
    }
    // The last step of the clock has two samples of ten.
    let short: String = coarse.split_inclusive('\n').take(192).collect();
    let found = samples(&format!("t,x,y,pressure\n{short}"));
    assert!((found[191].0 - 1.91).abs() < 1e-9, "{:?}", found[191]);
    // Never over a longer pause.
    let paused = samples("0 1 1 .5\n.01 2 1 .5\n.01 3 1 .5\n5 4 1 .5\n5.01 5 1 .5\n");
    assert!((paused[2].0 - 0.015).abs() < 1e-9, "{paused:?}");
    let same_time = read("1 1 1 .5\n1 2 1 .5\n").expect_err("one time");
    assert_eq!(same_time.place.as_deref(), Some("strokes.dat"));
}

#[test]
fn rounding_is_taken_back_and_noted_and_more_is_refused() {
    let imported = imported("0 1 1 1.000001 90 0\n.008 2 1 -1e-7 0 -87\n").expect("a take");
    let poses: Vec<_> = imported
        .take
        .samples
        .iter()
        .map(|sample| sample.sample.fault())
        .collect();
    assert_eq!(poses, [None, None]);
    assert_eq!(samples("0 1 1 1.000001\n")[0].1, 1.0);
    assert_eq!(imported.notes[..2], [Note::Pressures(2), Note::Tilts(2)]);
    for text in [
        "0 1 1 1.01\n",
        "0 1 1 -0.01\n",
        "0 1 1 1 0 90.1\n",
        "0 1 1 255\n",
    ] {
        assert!(fault(text).contains("strokes.dat:1"), "{text}");
    }
}

#[test]
fn columns_that_could_be_two_things_are_refused() {
    for text in [
        "0 300 300 .6 1\n",
        "0 300 300 .6 1 2 3 4\n",
        "t,x,y,pressure,tilt_x\n0,1,1,.5,1\n",
        "t,x,y\n0,1,1\n",
        "t,x,y,pressure,x\n0,1,1,.5,1\n",
        "1,234;300;300;0.5\n",
    ] {
        assert!(fault(text).contains("strokes.dat:1"), "{text}");
    }
}

proptest! {
    #[test]
    fn no_table_makes_the_import_panic_and_no_sample_is_lost(
        head in prop::sample::select(vec!["", "t,x,y,pressure\n", "t;x;y;pressure;stroke\n", "0 1 1 .5\n.008 2 1 .5\n"]),
        text in "([0-9.,;e\t \"\r\n#-]|[0-9] |[0-9],|0\\.[0-9] ){0,60}",
        rows in prop::collection::vec((0..50_u32, 0..1024_u32, 0..11_u32, 0..4_u32), 1..40),
    ) {
        drop(imported(&format!("{head}{text}")));
        // Strokes of rising or equal times.
        let mut lines = String::from("t,x,y,pressure,stroke\n");
        let mut rows = rows;
        rows.sort_by_key(|(t, .., stroke)| (*stroke, *t));
        for (t, x, p, stroke) in &rows {
            lines += &format!("{},{x},512,{},{stroke}\n", f64::from(*t) * 0.01, f64::from(*p) * 0.1);
        }
        if let Ok(imported) = imported(&lines) {
            let samples = &imported.take.samples;
            prop_assert!(samples.len() >= rows.len());
            prop_assert!(samples.is_sorted_by(|one, other| one.time_ns < other.time_ns), "{lines}");
            prop_assert!(samples.iter().all(|sample| sample.sample.fault().is_none()));
        }
    }
}
