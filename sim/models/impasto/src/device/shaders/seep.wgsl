// Flow of paint between bristles: from a fuller film to a thinner one beside it, up to their mean (seep.rs in
// maulstick-impasto). An invocation evens out two texels.

// The first pass goes between neighbouring strips, the second one along each strip.
override second: u32 = 0u;
// Difference between the films of two strips that remains, as a share of a full film (traits.rs in maulstick-model).
override HOLDS: f32;

// The part of a film up to `clings` does not flow.
fn even_out(a: u32, b: u32, part: f32, holds: f32, clings: f32) {
    let films = vec2(load[1u + a], load[1u + b]);
    if films.x == films.y {
        return;
    }
    let full = select(b, a, films.x > films.y);
    let thin = select(a, b, films.x > films.y);
    let most = max(films.x, films.y);
    let least = max(f32(min(films.x, films.y)), clings);
    let falls = max(max(f32(most), clings) - least - holds, 0.0);
    let share = 0.5 * part * falls / f32(most);
    var sum = 0u;
    for (var paint = 0u; paint < step.planes; paint++) {
        let film = film_of(paint);
        let goes = u32(f32(load[film + full]) * share);
        load[film + full] -= goes;
        load[film + thin] += goes;
        sum += goes;
    }
    load[1u + full] -= sum;
    load[1u + thin] += sum;
}

@compute @workgroup_size(64)
fn seep(@builtin(global_invocation_id) id: vec3<u32>) {
    let turn = load[0];
    let first = turn / 2u % 2u;
    if second == 0u {
        let pair = id.x / TEXELS_PER_STRIP;
        let place = first + 2u * pair;
        if place + 1u < step.strips {
            let order = 4u * step.faces + 2u * step.vertices + (2u + turn % 2u) * step.strips;
            let along = id.x % TEXELS_PER_STRIP;
            even_out(
                head[order + place] * TEXELS_PER_STRIP + along,
                head[order + place + 1u] * TEXELS_PER_STRIP + along,
                step.seep_beside,
                HOLDS * step.film_full,
                0.0,
            );
        }
        return;
    }
    let pairs = TEXELS_PER_STRIP / 2u;
    let strip = id.x / pairs;
    let begins = (load[0] + strip) % 2u;
    let along = begins + 2u * (id.x % pairs);
    if strip < step.strips && along + 1u < TEXELS_PER_STRIP {
        let texel = strip * TEXELS_PER_STRIP + along;
        even_out(texel, texel + 1u, step.seep_along, 0.0, step.clings);
    }
}
