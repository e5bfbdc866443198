//! Time lapses and logs of paintings, by the record that their files hold.

#[path = "../support/mod.rs"]
mod support;

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use support::{COARSE, Place, fault, has, info};

/// Size and bytes of a PNG of 8 bits.
fn pixels(path: &Path) -> ([u32; 2], Vec<u8>) {
    let file = BufReader::new(File::open(path).expect("there"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
    let frame = reader.next_frame(&mut bytes).expect("whole");
    bytes.truncate(frame.buffer_size());
    ([frame.width, frame.height], bytes)
}

/// Largest difference of two pictures of the same size.
fn apart(one: &[u8], other: &[u8]) -> u8 {
    assert_eq!(one.len(), other.len());
    let pairs = one.iter().zip(other);
    let apart = pairs.map(|(one, other)| one.abs_diff(*other));
    apart.max().expect("some")
}

/// What a command that succeeds complains of.
fn complaint(place: &Place, args: &[&str]) -> String {
    String::from_utf8_lossy(&place.done(args).stderr).into_owned()
}

/// The command for a time lapse of ten frames.
fn film<'a>(output: &[&'a str]) -> Vec<&'a str> {
    let film = ["painting", "timelapse", "x.maul"];
    let length = ["--seconds", "1", "--fps", "10", "-o"];
    [&film[..], &length, output].concat()
}

/// Its frames are as large as the painting, from the bare canvas to the finished picture, which holds.
fn check_frames(frames: &[([u32; 2], Vec<u8>)], finished: &([u32; 2], Vec<u8>)) {
    assert_eq!(frames.len(), 10);
    assert!(frames.iter().all(|(size, _)| *size == finished.0));
    assert!(apart(&frames[9].1, &finished.1) <= 1, "a pixel a cell");
    assert!(frames[9] == frames[8], "it holds");
    let painted = |frame: &[u8]| {
        let pairs = frame.iter().zip(&frames[0].1);
        pairs
            .filter(|(one, other)| one.abs_diff(**other) > 8)
            .count()
    };
    let painted: Vec<usize> = frames.iter().map(|(_, frame)| painted(frame)).collect();
    assert!(painted[2] > 0 && painted[2] < painted[4], "{painted:?}");
    assert!(frames[4] != frames[6] && frames[6] != frames[9]);
}

/// A GIF 100 pixels wide of the second's length, without frames that are as the one before.
fn check_gif(bytes: &[u8], [width, height]: [u32; 2]) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut gif = options.read_info(bytes).expect("a GIF");
    assert_eq!(
        (gif.width(), u32::from(gif.height())),
        (100, 100 * height / width)
    );
    let (mut shown, mut time) = (0, 0);
    while let Some(frame) = gif.read_next_frame().expect("whole") {
        (shown, time) = (shown + 1, time + frame.delay);
    }
    assert!((4..=10).contains(&shown), "{shown} frames that differ");
    assert_eq!(time, 100, "hundredths of a second");
}

#[test]
fn a_time_lapse_begins_with_the_canvas_and_ends_with_the_painting() {
    let place = Place::new();
    place.short_demo("take.mcap", 3.0);
    let render = ["render", "take.mcap", "--load", "Ultramarine Blue", "-o"];
    let file = ["first.png", "--document", "x.maul"];
    place.done(&[&render[..], &file[..], &COARSE[..]].concat());
    let twice = ["second.png", "--document", "x.maul"];
    place.done(&[&render[..], &twice[..]].concat());
    let before = place.bytes("x.maul");

    let error = complaint(&place, &film(&["frames/"]));
    assert_eq!(error, "", "it gives the painting again");
    let mut names: Vec<_> = std::fs::read_dir(place.path("frames"))
        .expect("a folder")
        .map(|file| file.expect("read").path())
        .collect();
    names.sort();
    let frames: Vec<_> = names.iter().map(|name| pixels(name)).collect();
    let finished = pixels(&place.path("second.png"));
    check_frames(&frames, &finished);
    place.done(&film(&["film.gif", "--width", "100"]));
    check_gif(&place.bytes("film.gif"), finished.0);
    assert_eq!(place.bytes("x.maul"), before, "the painting is only read");

    // Another kind of file does not give way.
    place.write("film.mp4", "a shopping list");
    for (output, code, words) in [
        ("frames", 1, &["frames", "new folder"][..]),
        ("film.mp4", 1, &["film.mp4", "--overwrite"]),
        ("film.avi", 2, &[".mp4 or .gif"]),
        ("x.maul", 2, &["maul"]),
    ] {
        has(&fault(&place, &film(&[output]), code), words);
    }
}

#[test]
fn an_mp4_without_ffmpeg_is_refused_with_advice() {
    let place = Place::new();
    place.short_demo("take.mcap", 1.0);
    let render = ["render", "take.mcap", "-o", "p.png", "--document", "x.maul"];
    place.done(&[&render[..], &COARSE[..]].concat());
    let film = ["painting", "timelapse", "x.maul", "-o", "film.mp4"];
    let mut command = place.maulstick(&film);
    let output = command.env("PATH", place.path("")).output().expect("run");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success());
    has(&error, &["ffmpeg is not installed", ".gif"]);
    assert!(!place.path("film.mp4").exists());
}

/// Number of strokes in the record of a painting; none without a record.
fn strokes(place: &Place) -> Option<u64> {
    info(place, "x.maul")["record"]["strokes"].as_u64()
}

/// The log has who did what, and a line for each stroke.
fn check_log(place: &Place, painted: u64) {
    has(
        &place.text(&["painting", "log", "x.maul"]),
        &[
            "time",
            "who",
            "what",
            "stroke of main on the canvas",
            " UTC",
            "begin a take of player with main, loaded with Bone Black",
        ],
    );
    let log = place.json(&["painting", "log", "x.maul", "--json"]);
    let lines = log["log"].as_array().expect("lines");
    let is_stroke = |line: &&serde_json::Value| line["kind"] == "stroke";
    assert_eq!(lines.iter().filter(is_stroke).count() as u64, painted);
    has(
        &place.text(&["painting", "info", "x.maul"]),
        &["record", &format!("{painted} strokes"), " UTC to "],
    );
}

#[test]
fn a_log_says_who_did_what_and_a_record_can_be_left_out_and_forgotten() {
    let place = Place::new();
    place.short_demo("take.mcap", 2.0);
    let render = ["render", "take.mcap", "--load", "Bone Black", "-o", "p.png"];
    let file = ["--document", "x.maul"];
    place.done(&[&render[..], &file[..], &COARSE[..]].concat());
    let painted = strokes(&place).expect("a record");
    assert!(painted > 0);
    check_log(&place, painted);

    // A picture is laid by no message.
    place.done(&["painting", "import", "x.maul", "p.png"]);
    assert_eq!(strokes(&place), Some(0));
    let film = ["painting", "timelapse", "x.maul", "--seconds", "0.5"];
    let film = [&film[..], &["-o", "film.gif"]].concat();
    assert_eq!(complaint(&place, &film), "");
    place.done(&[&render[..], &file[..]].concat());
    assert_eq!(strokes(&place), Some(painted));
    place.done(&["painting", "pack", "x.maul"]);
    assert_eq!(strokes(&place), Some(painted), "it stays");
    place.done(&["painting", "pack", "x.maul", "--forget-record"]);
    assert_eq!(strokes(&place), Some(0));

    place.done(&[&render[..], &file[..], &["--record", "0"]].concat());
    assert_eq!(info(&place, "x.maul")["record"], serde_json::Value::Null);
    has(&fault(&place, &film, 2), &["no record", "x.maul"]);
    has(
        &fault(&place, &["painting", "log", "x.maul"], 2),
        &["no record"],
    );
}
