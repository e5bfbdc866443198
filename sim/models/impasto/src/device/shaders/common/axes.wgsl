// Paint is pushed across first or up first, in turn.

fn along_y(second: u32, steps: u32) -> bool {
    return (second + steps) % 2u == 1u;
}
