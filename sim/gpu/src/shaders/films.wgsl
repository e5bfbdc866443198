// Kubelka-Munk films, four wavelengths at a time: the formulas of km.rs in maulstick-optics, term by term. An entry
// point is appended.

// Cells of a tile.
const CELLS = 4096u;

// Wavelengths.
override samples: u32 = 16u;
override quads: u32 = (samples + 3u) / 4u;

struct Tile {
    paints: u32,
    // Offsets of its thickness planes, its K and S, and its ground.
    thickness: u32,
    optics: u32,
    under: u32,
    // Strides of the ground: from one wavelength to the next, and from cell to cell.
    under_sample: u32,
    under_cell: u32,
}

@group(0) @binding(0) var<storage, read> tiles: array<Tile>;
// Red, green and blue of four wavelengths, for all of them; then for each tile K and S of each paint
// at four wavelengths, and so on.
@group(0) @binding(1) var<storage, read> optics: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> thickness: array<f32>;
@group(0) @binding(3) var<storage, read> under: array<f32>;
@group(0) @binding(4) var<storage, read_write> out: array<f32>;

struct Ratio {
    n: vec4<f32>,
    m: vec4<f32>,
}

// Decay::NEAR of maulstick-num.
const NEAR = 0.346;

struct Decay {
    end: vec4<f32>,
    mean: vec4<f32>,
}

// decay_f32 of maulstick-num. WGSL's own exp may be off by 3 + 2t units in the last place. round() replaces adding
// and subtracting a large number, which fast arithmetic may leave out.
fn decay(t: vec4<f32>) -> Decay {
    let x = -min(t, vec4(40.0));
    let n = round(x * 1.44269504);
    let r = x - n * 0.693359375 - n * -2.12194442e-4;
    var p = vec4(1.0 / 5040.0);
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    let mean = p * r + 1.0;
    let power = bitcast<vec4<f32>>((vec4<i32>(n) + 127) << vec4(23u));
    return Decay((mean * r + 1.0) * power, mean);
}

// The film of K·d and S·d over a ground: its reflectance is n/m.
fn film_over(kd: vec4<f32>, sd: vec4<f32>, ground: vec4<f32>) -> Ratio {
    let t = sqrt(kd * (kd + 2.0 * sd));
    let decay = decay(t);
    let near = t <= vec4(NEAR);
    let g = (1.0 + decay.end) * select(1.0 - decay.end, decay.mean, near);
    let c = (1.0 + decay.end * decay.end) * select(t, vec4(1.0), near);
    let free = 1.0 - ground;
    return Ratio(sd * g * free + ground * (c - kd * g), (kd + sd * free) * g + c);
}

fn ground(tile: Tile, cell: u32, sample: u32) -> f32 {
    // The last group may have fewer wavelengths; the others have weight 0.
    let at = min(sample, samples - 1u);
    return under[tile.under + at * tile.under_sample + cell * tile.under_cell];
}

// The film of a cell at four wavelengths.
fn film(tile: Tile, cell: u32, quad: u32) -> Ratio {
    var kd = vec4(0.0);
    var sd = vec4(0.0);
    for (var paint = 0u; paint < tile.paints; paint++) {
        let d = thickness[tile.thickness + paint * CELLS + cell];
        let at = tile.optics + 2u * (quad * tile.paints + paint);
        kd += optics[at] * d;
        sd += optics[at + 1u] * d;
    }
    let sample = 4u * quad;
    let under = vec4(
        ground(tile, cell, sample),
        ground(tile, cell, sample + 1u),
        ground(tile, cell, sample + 2u),
        ground(tile, cell, sample + 3u),
    );
    return film_over(kd, sd, under);
}
