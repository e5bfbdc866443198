//! Tools at the sides of the window: the rack at that of the hand, the column of panels at the painter's choice.

use crate::app::rack;
use crate::settings::preferences::Preferences;
use crate::settings::window_side::WindowSide;

/// Width of the column's inside, points.
pub(crate) const COLUMN: f32 = 314.0;
/// Distance of the column from its neighbours, points.
pub(crate) const MARGIN: f32 = 8.0;
/// Width of the window below which the column replaces the rack, points.
pub(crate) const NARROW: f32 = 1000.0;

/// Displayed side of the rack.
#[must_use]
pub(crate) fn rack_side(preferences: &Preferences) -> WindowSide {
    if preferences.rack_is_left() {
        WindowSide::Left
    } else {
        WindowSide::Right
    }
}

/// The side of the column: beside the rack, unless the painter has put it elsewhere.
#[must_use]
pub(crate) fn column_side(preferences: &Preferences) -> WindowSide {
    preferences
        .window
        .panel_side
        .unwrap_or_else(|| rack_side(preferences))
}

/// Width of the column at a side with its margins, points; 0 if it is not there.
#[must_use]
pub(crate) fn column_at(preferences: &Preferences, side: WindowSide) -> f32 {
    if preferences.window.panels && column_side(preferences) == side {
        COLUMN + 6.0 * MARGIN
    } else {
        0.0
    }
}

/// True if the rack is shown: in a narrow window it gives way to the column.
#[must_use]
pub(crate) fn has_rack(preferences: &Preferences) -> bool {
    !(preferences.window.is_narrow && preferences.window.panels)
}

/// Width of the rack at a side, points; 0 if it is not there.
#[must_use]
pub(crate) fn rack_at(preferences: &Preferences, side: WindowSide) -> f32 {
    if has_rack(preferences) && rack_side(preferences) == side {
        rack::WIDTH
    } else {
        0.0
    }
}

/// Widths of both at the left and at the right, points.
#[must_use]
pub(crate) fn taken(preferences: &Preferences) -> [f32; 2] {
    [WindowSide::Left, WindowSide::Right]
        .map(|side| rack_at(preferences, side) + column_at(preferences, side))
}

#[cfg(test)]
mod tests {
    use crate::settings::preferences::WindowPreferences;

    use super::*;

    #[test]
    fn rack_and_column_take_room_where_they_stand() {
        let wide = COLUMN + 6.0 * MARGIN;
        let of = |panels, left_handed, panel_side| {
            taken(&Preferences::of_window(WindowPreferences {
                panels,
                left_handed,
                panel_side,
                ..WindowPreferences::default()
            }))
        };
        assert_eq!(of(false, false, Some(WindowSide::Left)), [0.0, rack::WIDTH]);
        assert_eq!(of(true, false, None), [0.0, rack::WIDTH + wide]);
        assert_eq!(of(true, true, None), [rack::WIDTH + wide, 0.0]);
        let left = Some(WindowSide::Left);
        assert_eq!(of(true, false, left), [wide, rack::WIDTH]);
        assert_eq!(of(true, true, left), [rack::WIDTH + wide, 0.0]);
        let narrow = |panels| {
            taken(&Preferences::of_window(WindowPreferences {
                panels,
                is_narrow: true,
                ..WindowPreferences::default()
            }))
        };
        assert_eq!(narrow(true), [0.0, wide], "the rack gives way");
        assert_eq!(narrow(false), [0.0, rack::WIDTH]);
    }
}
