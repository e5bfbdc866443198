//! A libHD for tests.
