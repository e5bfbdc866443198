//! Bad measurements by their message, and guesses by their warning.

use maulstick_measure::{FitOptions, MeasureError, Warning, fit, parse_surface};
use proptest::prelude::*;

const HEAD: &str = "sample,kind,Titanium White,Cobalt Blue,thickness_um,over,400,500,600,700";
/// Good rows, from line 2.
const ROWS: [&str; 4] = [
    "white,,1,,,,0.5014,0.8879,0.8879,0.8879",
    "blue,,,1,,,0.2025,0.0770,0.0459,0.0601",
    "tint,,0.5,0.5,,,0.4172,0.2704,0.1476,0.2122",
    "pale,,0.9,0.1,,,0.4882,0.5549,0.3894,0.4857",
];

fn table(row: &str) -> String {
    format!("{HEAD}\n{}\n{row}\n", ROWS.join("\n"))
}

fn bad_with(text: &str, options: &FitOptions) -> MeasureError {
    fit(text, options).expect_err(text)
}

/// The error of a table whose sixth line is `row`.
fn bad(row: &str) -> MeasureError {
    bad_with(&table(row), &FitOptions::default())
}

fn warnings(text: &str) -> Vec<Warning> {
    fit(text, &FitOptions::default()).expect("fitted").warnings
}

#[test]
fn readings_that_none_can_be() {
    for (row, says, helps) in [
        (
            "x,,1,,,,0.5,1.25,0.5,0.5",
            "column 8 (500): a reflectance of 1.2500 at 500 nm is above 1.2",
            "standard",
        ),
        (
            "x,,1,,,,50,90,90,90",
            "column 7 (400): a reflectance of 50.0000 at 400 nm is above 1.2",
            "per cent",
        ),
        (
            "x,,1,,,,0.5,-0.1,0.5,0.5",
            "column 8 (500): -0.1 at 500 nm is negative",
            "write 0",
        ),
        (
            "x,,1,,,,0.5,0.5,,0.5",
            "column 9 (600): the reading at 600 nm is missing",
            "column",
        ),
        (
            "x,,1,,,,0.5,0.5,0.5",
            "column 10 (700): the reading at 700 nm is missing",
            "column",
        ),
        (
            "x,,1,,,,0.5,a,0.5,0.5",
            "column 8 (500): 'a' is not a number",
            "0.25",
        ),
        (
            "x,,1,,,,0.5,NaN,0.5,0.5",
            "column 8 (500): 'NaN' is not finite",
            "0.25",
        ),
        (
            "x,,1,,,,0.5,0.5,0.5,0.5,0.5",
            "column 11: 11 columns, but the table has 10",
            "heading",
        ),
        (
            "x,smaple,1,,,,0.5,0.5,0.5,0.5",
            "column 2 (kind): 'smaple' is not a kind of row",
            "'sample'",
        ),
    ] {
        let error = bad(row);
        assert_eq!(error.to_string(), format!("line 6, {says}"));
        assert!(error.help.contains(helps), "{}", error.help);
    }
}

#[test]
fn shares_that_do_not_sum_to_one() {
    for (shares, says, helps) in [
        (
            "0.5,0.4",
            "column 4 (Cobalt Blue): the shares sum to 0.9000, not to 1",
            "divide",
        ),
        (
            ",",
            "column 3 (Titanium White): the shares sum to 0.0000, not to 1",
            "divide",
        ),
        (
            "50,50",
            "column 4 (Cobalt Blue): the shares sum to 100.0000, not to 1",
            "per cent",
        ),
        (
            "1,5",
            "column 4 (Cobalt Blue): the shares sum to 6.0000, not to 1",
            "divide weights",
        ),
        (
            "-0.5,1.5",
            "column 3 (Titanium White): the share -0.5 is negative",
            "0 to 1",
        ),
        (
            "half,0.5",
            "column 3 (Titanium White): 'half' is not a share of 'Titanium White'",
            "0.25",
        ),
    ] {
        let error = bad(&format!("x,,{shares},,,0.5,0.5,0.5,0.5"));
        assert_eq!(error.to_string(), format!("line 6, {says}"));
        assert!(error.help.contains(helps), "{}", error.help);
    }
    // Rounded thirds are no mistake.
    assert!(
        fit(
            &table("x,,0.667,0.333,,,0.65,0.5,0.3,0.35"),
            &FitOptions::default()
        )
        .is_ok()
    );
}

#[test]
fn drawdowns_that_lack_something() {
    for (film, says, helps) in [
        (
            "30,",
            "column 5 (thickness_um): a thickness, but over what?",
            "black, white",
        ),
        (
            ",black",
            "column 6 (over): a drawdown without `thickness_um`",
            "hides",
        ),
        (
            "thin,black",
            "column 5 (thickness_um): 'thin' is not a thickness",
            "µm",
        ),
        (
            "0,black",
            "column 5 (thickness_um): '0' is not a thickness",
            "µm",
        ),
        (
            "30,blakc",
            "column 6 (over): no row of kind ground is called 'blakc'",
            "'black'",
        ),
        (
            "30,80",
            "column 6 (over): no ground reflects 80",
            "per cent",
        ),
    ] {
        let error = bad(&format!("x,,1,,{film},0.5,0.5,0.5,0.5"));
        assert_eq!(error.to_string(), format!("line 6, {says}"));
        assert!(error.help.contains(helps), "{}", error.help);
    }
}

#[test]
fn paints_that_are_unknown_or_not_measured() {
    let named = |white: &str| FitOptions {
        white: Some(white.into()),
        ..FitOptions::default()
    };
    let error = bad_with(&table(""), &named("Titanum White"));
    assert_eq!(error.to_string(), "no column is called 'Titanum White'");
    assert!(error.help.contains("'Titanium White'"), "{}", error.help);
    let text = format!("# reference white: Kobalt Blue\n{}", table(""));
    let error = bad_with(&text, &FitOptions::default());
    assert_eq!(
        error.to_string(),
        "line 1: no column is called 'Kobalt Blue'"
    );

    let whiteless = table("").replace("Titanium White", "Chalk");
    let error = bad_with(&whiteless, &FitOptions::default());
    assert_eq!((error.place.line, error.place.column), (Some(1), None));
    assert!(error.help.contains("--white"));
    assert!(fit(&whiteless, &named("chalk")).is_ok());
    let zinc = table("").replace("Titanium White", "Zinc White");
    assert_eq!(
        fit(&zinc, &FitOptions::default()).expect("fitted").white,
        "Zinc White"
    );
}

#[test]
fn singular_fits() {
    let text = format!("{HEAD}\n{}\n", ROWS[0]);
    assert_eq!(
        bad_with(&text, &FitOptions::default()).to_string(),
        "line 1, column 4 (Cobalt Blue): no sample holds 'Cobalt Blue'"
    );
    let text = format!("{HEAD}\n{}\n{}\n", ROWS[0], ROWS[1]);
    let error = bad_with(&text, &FitOptions::default());
    assert_eq!(
        error.to_string(),
        "line 3, column 4 (Cobalt Blue): the fit is singular: no sample ties 'Cobalt Blue' to the \
         reference white 'Titanium White'"
    );
    assert!(error.help.contains("1:1 or 1:10"));
}

#[test]
fn guesses_and_strange_readings() {
    assert_eq!(warnings(&table("")), []);
    let grounds = warnings(&table(
        "x,,1,,40,black,0.7,0.8,0.8,0.8\ny,,1,,40,white,0.8,0.9,0.9,0.9",
    ));
    for ground in [Warning::BlackGround, Warning::WhiteGround(0.8)] {
        assert!(grounds.contains(&ground), "{grounds:?}");
    }
    let high = warnings(&table("x,,1,,,,0.8,1.05,0.9,0.9"));
    let is_high = |warning: &Warning| matches!(warning, Warning::High { line: 6, reading, .. } if *reading == 1.05);
    assert!(high.iter().any(is_high), "{high:?}");
    let low = warnings(&table("x,,,1,,,0.4,0.2,0.005,0.1"));
    let is_low = |warning: &Warning| matches!(warning, Warning::Low { line: 6, .. });
    assert!(low.iter().any(is_low), "{low:?}");
    let short = warnings(&table("").replace("700", "680"));
    let (first, last) = (400.0, 680.0);
    assert_eq!(short[0], Warning::Range { first, last });
}

#[test]
fn a_surface_is_two_numbers_or_none() {
    assert_eq!(parse_surface("none").map(|surface| surface.k2), Ok(0.0));
    assert_eq!(
        parse_surface("0.04, 0.6").map(|surface| surface.k1),
        Ok(0.04)
    );
    for text in ["", "0.03", "0.03,x", "0.03,0.65,1", "1,0.65", "NaN,0.6"] {
        assert!(parse_surface(text).is_err(), "{text}");
    }
}

#[test]
fn a_white_alone_is_fitted() {
    let text = "Titanium White,400,550,700\n1,0.9,0.9,0.9\n";
    let found = fit(text, &FitOptions::default()).expect("fitted");
    assert_eq!(found.residuals[0].name, "Titanium White");
    assert!(found.worst() < 0.5, "{}", found.worst());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_mutation_of_a_table_breaks_the_fit(
        edits in prop::collection::vec((0usize..400, "[-0-9.,;:#\"a\n]{0,3}"), 1..6),
    ) {
        let mut text: Vec<char> = table("x,,1,,40,black,0.4,0.7,0.7,0.7").chars().collect();
        for (place, piece) in edits {
            let place = place % text.len();
            text.splice(place..=place, piece.chars());
        }
        let text: String = text.into_iter().collect();
        if let Ok(found) = fit(&text, &FitOptions::default()) {
            let file = maulstick_measure::paint_file(&found);
            prop_assert!(maulstick_optics::PaintLibrary::parse(&file).is_ok(), "{text}");
        }
    }
}

#[test]
fn readings_of_half_the_spectrum_are_refused() {
    let text = "Titanium White,400,450,500\n1,0.9,0.9,0.9\n";
    let error = fit(text, &FitOptions::default()).expect_err("too little");
    assert!(error.what.contains("400") && error.what.contains("500"));
}

#[test]
fn a_table_of_too_many_columns_is_refused_before_it_is_read() {
    let heads: String = (0..100_000)
        .map(|i| format!(",{:.3}", 380.0 + 0.004 * f64::from(i)))
        .collect();
    let table = format!(
        "sample,Titanium White{heads}\nwhite,1{}\n",
        ",0.9".repeat(100_000)
    );
    let error = fit(&table, &FitOptions::default()).expect_err("too many");
    assert!(
        error.what.contains("100002") && error.what.contains("2500"),
        "{error:?}"
    );
    assert!(error.help.contains("average"), "{error:?}");
}
