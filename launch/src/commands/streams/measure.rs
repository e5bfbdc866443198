//! `maulstick topic list`, `hz` and `latency`: streams measured for some seconds.

use std::time::Duration;

use clap::Args;
use maulstick_recorder::Listener;
use maulstick_rig::UserError;
use maulstick_streams::Traffic;
use maulstick_streams::catalogue::message_of;
use maulstick_streams::traffic::{Distribution, Stream};
use maulstick_types::Origin;
use serde_json::{Value, json};

use crate::commands::client::Target;
use crate::commands::table::table;
use crate::commands::{print_json, print_text, say};

/// Options of `maulstick topic list`, `hz` and `latency`.
#[derive(Args, Clone, Debug)]
pub struct MeasureOptions {
    /// Topic, such as stylus/*/sample: * stands for one part, ** for any number
    #[arg(default_value = "**")]
    topic: String,
    /// Measure for so long, s
    #[arg(long, value_name = "S", default_value_t = 2.0)]
    seconds: f64,
    /// Measure once; otherwise again and again until Ctrl-C
    #[arg(long)]
    once: bool,
    /// Print JSON, once
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Subject of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    Topics,
    /// Rates of messages, and numbers of missing ones.
    Rates,
    Delays,
}

/// Measures and prints.
///
/// # Errors
/// A [`UserError`] if no rig runs, or for a time out of range.
pub(super) fn run(options: &MeasureOptions, measure: Measure) -> Result<i32, UserError> {
    let time = duration(options.seconds)?;
    let mut listener = Listener::open(options.target.rig(), &options.topic)?;
    loop {
        let dropped = listener.dropped();
        let traffic = listener.traffic(time);
        if options.json {
            let streams: Vec<Value> = traffic.streams().map(entry).collect();
            print_json(&json!({
                "seconds": options.seconds,
                "streams": streams,
                "dropped_here": listener.dropped() - dropped,
                "foreign": listener.foreign,
            }))?;
            return Ok(0);
        }
        print_text(&shown(&traffic, measure))?;
        let dropped = listener.dropped() - dropped;
        if dropped > 0 {
            say!(
                "{dropped} messages came faster than this program reads, and count as lost here alone"
            );
        }
        if listener.foreign > 0 {
            say!(
                "{} messages so far are none of Maulstick's",
                listener.foreign
            );
        }
        if options.once || listener.is_over() || !listener.has_rig() {
            return Ok(0);
        }
        print_text("\n")?;
    }
}

/// A time to measure for.
///
/// # Errors
/// A [`UserError`] for one that is out of range.
pub(super) fn duration(seconds: f64) -> Result<Duration, UserError> {
    if !(0.1..=3600.0).contains(&seconds) {
        let what = format!("{seconds} s is out of range");
        return Err(UserError::usage(what).help("measure for .1 to 3600 s"));
    }
    Ok(Duration::from_secs_f64(seconds))
}

/// Name and version of the messages of a hash.
#[must_use]
fn message_name(schema: u32) -> String {
    message_of(schema).map_or_else(
        || format!("unknown {schema:#010x}"),
        |entry| format!("{} {}", entry.name, entry.version),
    )
}

/// A stream with its topic and sender.
type Row<'a> = (&'a str, Origin, &'a Stream);

fn entry((topic, origin, stream): Row<'_>) -> Value {
    let times = |of: &Distribution| {
        let [p50, p90, p99] = [0.5, 0.9, 0.99].map(|share| of.quantile(share));
        let times = json!({"p50": p50, "p90": p90, "p99": p99, "most": of.most()});
        (!of.is_empty()).then_some(times)
    };
    json!({
        "topic": topic,
        "source": origin.source,
        "epoch": origin.epoch,
        "message": message_name(stream.schema),
        "messages": stream.messages,
        "bytes": stream.bytes,
        "rate_hz": stream.rate_hz(),
        "lost": stream.lost,
        "disordered": stream.disordered,
        "gap_ns": times(&stream.gaps),
        "transit_ns": times(&stream.transit),
        "age_ns": times(&stream.age),
    })
}

/// Quantiles of times as milliseconds, the longest for 1.
fn ms<const N: usize>(times: &Distribution, shares: [f64; N]) -> [String; N] {
    shares.map(|share| {
        let ns = match share {
            1.0 => times.most(),
            share => times.quantile(share),
        };
        if times.is_empty() {
            "-".to_owned()
        } else {
            format!("{:.2}", ns as f64 * 1e-6)
        }
    })
}

fn shown(traffic: &Traffic, measure: Measure) -> String {
    let streams: Vec<Row<'_>> = traffic.streams().collect();
    if streams.is_empty() {
        return "no message arrived: `maulstick node list` lists the running nodes\n".into();
    }
    match measure {
        Measure::Topics => {
            let rows = streams.iter().map(|(topic, _, stream)| {
                let rate = format!("{:.1}", stream.rate_hz());
                let bytes = stream.bytes / stream.messages.max(1);
                [
                    (*topic).to_owned(),
                    message_name(stream.schema),
                    rate,
                    bytes.to_string(),
                ]
            });
            let rows: Vec<_> = rows.collect();
            table(["topic", "message", "a second", "bytes each"], &rows)
        }
        Measure::Rates => {
            let rows = streams.iter().map(|(topic, _, stream)| {
                let [p50, p99, most] = ms(&stream.gaps, [0.5, 0.99, 1.0]);
                let rate = format!("{:.1}", stream.rate_hz());
                let [heard, lost] = [stream.messages, stream.lost].map(|count| count.to_string());
                [(*topic).to_owned(), rate, p50, p99, most, heard, lost]
            });
            let rows: Vec<_> = rows.collect();
            let head = [
                "topic",
                "a second",
                "gap p50, ms",
                "p99",
                "most",
                "heard",
                "lost",
            ];
            table(head, &rows)
        }
        Measure::Delays => {
            let rows = streams.iter().map(|(topic, _, stream)| {
                let [p50, p90, p99, most] = ms(&stream.transit, [0.5, 0.9, 0.99, 1.0]);
                let [age] = ms(&stream.age, [0.5]);
                let lost = stream.lost.to_string();
                [(*topic).to_owned(), p50, p90, p99, most, age, lost]
            });
            let rows: Vec<_> = rows.collect();
            let head = [
                "topic",
                "on the way p50, ms",
                "p90",
                "p99",
                "most",
                "age p50, ms",
                "lost",
            ];
            table(head, &rows)
        }
    }
}
