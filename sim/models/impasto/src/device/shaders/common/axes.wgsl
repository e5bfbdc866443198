// Paint is pushed across and then up, or the other way about, in turn.

fn along_y(second: u32, steps: u32) -> bool {
    return (second + steps) % 2u == 1u;
}
