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
        text.contains("strokes.dat:2") && text.contains("pressure) is missing"),
        "{text}"
    );
    let text = fault(&format!("{good}0.1 one 1 0\n"));
    assert!(
        text.contains("column 2 (x): 'one' is not a number"),
        "{text}"
    );
    assert!(fault(&format!("{good}0.1 1 1 NaN\n")).contains("'NaN' is not finite"));
    assert!(fault(&format!("{good}-1 1 1 0\n")).contains("time runs backward"));
    assert!(fault("0 1 1 1.5\n").contains("1.5 is not within 0 and 1"));
    assert!(fault("0 1 1 1 89 0\n").contains("tilt_x"));
    assert!(fault("t x y presure\n0 1 1 1\n").contains("'pressure'"));
    assert!(fault("# nothing\n").contains("no samples"));
}

#[test]
fn of_two_samples_of_a_time_the_last_counts() {
    let take = read("0 1 1 0\n0 2 2 0\n0.1 3 3 0\n").expect("a take");
    assert_eq!(take.samples.len(), 2);
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
    for (step, unit) in [(8.0, "ms"), (16.7, "ms"), (8000.0, "us"), (8e6, "ns")] {
        let imported = imported(&stroke(step)).expect("a take");
        let [note] = imported.notes.as_slice() else {
            panic!("{step}: {:?}", imported.notes);
        };
        assert!(note.contains(&format!("in {unit}:")), "{note}");
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
    let note = &imported("0 100 100 0.5\n0.008 2000 900 0.5\n")
        .expect("near")
        .notes[0];
    assert!(note.contains("1 of 2") && note.contains("--size"), "{note}");
}

#[test]
fn what_paints_nothing_is_said() {
    let gap = format!("{}1 420 512 0.5\n1.008 421 512 0.5\n", stroke(0.008));
    let notes = imported(&gap).expect("a take").notes;
    assert!(
        notes[0].contains("line 21") && notes[0].contains("0.3 s"),
        "{notes:?}"
    );
    let notes = imported("0 1 1 0\n0.1 2 2 0\n").expect("a take").notes;
    assert!(notes[0].contains("paints nothing"), "{notes:?}");
    // The pen is lifted in between.
    let lifted = format!("{}0.2 420 512 0\n1 420 512 0.5\n", stroke(0.008));
    assert!(imported(&lifted).expect("a take").notes.is_empty());
}
