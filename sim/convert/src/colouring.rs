//! How counts become colours.

/// How the counts of a paint model become colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colouring {
    /// Films over each other (Kubelka and Munk; Baxter 2004, ch. 7).
    Films,
    /// Encoded colours mixed by volume, each layer over the one below (Baxter 2004, § 4.5.2).
    Volumes,
}
