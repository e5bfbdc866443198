//! `maulstick device force` as its users call it.

#[path = "../support/mod.rs"]
mod support;

use serde_json::Value;
use support::{Place, fault, has};

/// Rows of the command: depth, angle, force, stiffness.
fn rows(place: &Place, arguments: &[&str]) -> Vec<[f64; 4]> {
    let said = place
        .done(&[&["device", "force", "--json"], arguments].concat())
        .stdout;
    let text = String::from_utf8(said).expect("UTF-8");
    let names = ["depth_m", "angle_rad", "force_n", "stiffness_n_per_m"];
    let row = |line: &str| {
        let row: Value = serde_json::from_str(line).expect("a line a row");
        names.map(|name| row[name].as_f64().expect("a number"))
    };
    text.lines().map(row).collect()
}

#[test]
fn the_curve_rises_at_every_angle_and_its_first_touch_goes_with_the_angle() {
    let place = Place::new();
    let plot = "force.png";
    let arguments = [
        "--model",
        "hermite",
        "--brush",
        "round",
        "--depth-mm",
        "0..40",
        "--angle-deg",
        "0,15,30,45",
        "--plot",
        plot,
    ];
    let rows = rows(&place, &arguments);
    assert_eq!(rows.len(), 4 * 81);
    for pair in rows.windows(2).filter(|pair| pair[0][1] == pair[1][1]) {
        assert!(pair[1][2] >= pair[0][2], "{pair:?}");
        assert!(pair[1][3] <= 500.0);
    }
    // The second tuple, at 6 % of the length along the normal, is .5 N by cos² 2θ.
    for (degrees, factor) in [("0", 1.0), ("15", 0.75), ("30", 0.25), ("45", 0.0)] {
        let angle: f64 = f64::to_radians(degrees.parse().expect("a number"));
        let depth = (0.06 * 25.0 * maulstick_num::cos(angle)).to_string();
        let row = &self::rows(&place, &["--depth-mm", &depth, "--angle-deg", degrees])[0];
        assert!((row[2] - 0.5 * factor).abs() < 1e-9, "{degrees}°: {row:?}");
    }
    let picture = std::fs::read(place.path(plot)).expect("a picture");
    assert_eq!(&picture[1..4], b"PNG");
}

#[test]
fn two_straight_pieces_are_those_of_equation_8_1() {
    let place = Place::new();
    for (degrees, along) in [(0.0, 0.025), (60.0, 0.0125), (85.0, 0.005)] {
        let angle = degrees.to_string();
        let arguments = [
            "--model",
            "linear",
            "--angle-deg",
            &angle,
            "--depth-mm",
            "0,2,40",
            "--max-stiffness-n-m",
            "100000",
        ];
        let rows = rows(&place, &arguments);
        let (k1, k2) = (0.8 / along, 6.0 / along);
        let deep = 0.8 + k2 * (0.04 - along);
        for (row, expected) in rows.iter().zip([0.0, k1 * 0.002, deep]) {
            assert!(
                (row[2] - expected).abs() < 1e-9,
                "{row:?}, expected {expected} N"
            );
        }
        assert!((rows[1][3] - k1).abs() < 1e-9 && (rows[2][3] - k2).abs() < 1e-9);
    }
}

#[test]
fn the_other_laws_are_what_they_are_called() {
    let place = Place::new();
    let at = |model: &str| rows(&place, &["--model", model, "--depth-mm", "0..10"]);
    assert!(at("none").iter().all(|row| row[2] == 0.0 && row[3] == 0.0));
    assert!(
        at("rigid")
            .iter()
            .all(|row| (row[2] - 500.0 * row[0]).abs() < 1e-9)
    );
    let solved = at("local");
    assert!(
        solved
            .iter()
            .all(|row| (0.0..3.0).contains(&row[2]) && row[3] <= 500.0)
    );
    assert!(solved.iter().any(|row| row[2] > 0.3));
}

#[test]
fn bad_options_are_refused_in_one_line() {
    let place = Place::new();
    let refused =
        |arguments: &[&str]| fault(&place, &[&["device", "force"], arguments].concat(), 2);
    has(&refused(&["--depth-mm", "9..1"]), &["'9..1'", "0..40"]);
    has(&refused(&["--angle-deg", "200"]), &["'200'", "0 to 90"]);
    has(&refused(&["--brush", "rond"]), &["'rond'", "'round'"]);
    let flat = ["--model", "local", "--angle-deg", "85"];
    has(&refused(&flat), &["85°", "--angle-deg", "80°"]);
}
