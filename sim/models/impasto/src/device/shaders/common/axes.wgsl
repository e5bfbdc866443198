// Paint is pushed across first or up first, in turn.

fn along_y(second: u32, steps: u32) -> bool {
    return (second + steps) % 2u == 1u;
}

// The paints of a cell or a texel in one word: NONE, the only one, or SEVERAL.
const SEVERAL = NONE - 1u;

// The paint that is there besides another.
fn besides(one: u32, other: u32) -> u32 {
    if other == NONE {
        return one;
    }
    return select(SEVERAL, other, one == NONE || one == other);
}

// What of a paint is in the upper sheet of a cell.
fn upper_of(paint: u32, cell: u32) -> u32 {
    return (step.planes + paint) * step.plane + cell;
}

// The paints as a number that a buffer of numbers holds, and back.
fn as_number(only: u32) -> f32 {
    return select(select(f32(only), -2.0, only == SEVERAL), -1.0, only == NONE);
}

fn as_paints(number: f32) -> u32 {
    return select(select(u32(max(number, 0.0)), SEVERAL, number == -2.0), NONE, number == -1.0);
}
