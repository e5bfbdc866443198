//! Numbers of a brush file that a painter may set.

use maulstick_types::quantity;

quantity! {
    /// Width of the head, mm.
    pub HeadWidth: "head.width_mm", 0.1..=300.0, 0.5..=60.0, " mm",
    "Width of the head. A wider brush is longer and stiffer in proportion."
}
quantity! {
    /// Paint on the bristles of a freshly loaded brush, µm.
    pub LoadFilm: "load.film_um", 0.0..=2000.0, Self::RANGE, " µm",
    "Thickness of paint on the bristles of a freshly loaded brush."
}
quantity! {
    /// Paint within the head, µm.
    pub LoadInside: "load.inside_um", 0.0..=2000.0, Self::RANGE, " µm",
    "Paint within the head, as thick as if it were spread over the bristles: with more of it a stroke is longer."
}
quantity! {
    /// Difference between strips in how much they carry.
    pub Unevenness: "strips.unevenness", 0.0..=1.0, Self::RANGE, "",
    "By which share bristles differ in how much they carry: uneven ones leave streaks."
}
quantity! {
    /// Distance of the most unruly strip from the surface, mm.
    pub Lift: "strips.lift_mm", 0.0..=10.0, 0.0..=3.0, " mm",
    "How far the most unruly bristle keeps off the surface while the brush is hardly pressed."
}
quantity! {
    /// Width of the fully pressed point, by that of the head.
    pub Opening: "strips.open", 0.0..=2.0, Self::RANGE, "",
    "Width of the fully pressed point, by that of the head."
}
quantity! {
    /// Coefficient of friction while sliding.
    pub Friction: "contact.friction", 0.0..=2.0, 0.0..=1.0, "",
    "Friction of the bristles on the canvas."
}
