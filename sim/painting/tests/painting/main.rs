//! Tests of whole paintings, by subject.

mod books;
mod converting;
mod cut;
mod drying;
mod extremes;
mod hairline;
mod light;
mod loading_from;
mod models;
mod modes;
mod pauses;
mod relief;
mod scraping;
mod sequencer;
mod studio;
mod threads;
mod varnish;
