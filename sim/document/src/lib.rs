//! The painting as a file.
