//! Prints the streams of a recording: messages, rate, losses, and how old a sample was when it arrived.
//!
//! ```text
//! cargo run --release -p maulstick-streams --example rates -- session.mcap
//! ```

use std::error::Error;
use std::path::Path;

use maulstick_streams::traffic::Arrived;
use maulstick_streams::{Recording, Traffic};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args()
        .nth(1)
        .ok_or("name a recording: rates session.mcap")?;
    let mut recording = Recording::open(Path::new(&path)).map_err(|error| error.to_string())?;
    let topics = recording.topics().clone();
    let mut traffic = Traffic::default();
    let mut count = |read: maulstick_streams::recording::RecordedMessage| {
        let arrived = Arrived {
            header: read.header,
            bytes: read.bytes.len(),
            arrived_ns: read.arrived_ns,
        };
        traffic.add(&topics[&read.channel].name, &arrived);
        true
    };
    let read = recording.messages([0, u64::MAX], &mut count);
    read.map_err(|error| error.to_string())?;
    println!(
        "{:<40} {:>8} {:>8} {:>6} {:>12}",
        "topic", "messages", "Hz", "lost", "median age"
    );
    for (topic, _, stream) in traffic.streams() {
        let age_ms = stream.age.quantile(0.5) as f64 * 1e-6;
        println!(
            "{topic:<40} {:>8} {:>8.1} {:>6} {age_ms:>9.2} ms",
            stream.messages,
            stream.rate_hz(),
            stream.lost
        );
    }
    Ok(())
}
