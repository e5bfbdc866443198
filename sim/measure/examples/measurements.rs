//! Prints the example of the guide, `docs/examples/measurements.csv`.

#[path = "../tests/support/mod.rs"]
mod support;

fn main() {
    print!("{}", support::guide::table());
}
