//! Each stage of the impasto step against a plain oracle in f64 that follows its documentation, and the whole step
//! against its invariants. Each comparison has a seeded fault that it must find.

mod advection;
mod exchange;
mod flow;
mod footprint;
mod levelling;
mod ride;
mod scene;
mod seep;
mod skin;
mod spread;
mod stroke;
mod velocity;
