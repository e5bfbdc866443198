//! Paintings to and from other programs.
