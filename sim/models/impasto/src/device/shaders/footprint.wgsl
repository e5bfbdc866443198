// Covered cells that are touched: the lowest part, with its film of paint, reaches the top of the surface or paint
// there.

// Constants of velocity.rs.
override SQUISH: f32;
override STABLE: f32;
override SLIP: f32;
override EASE: f32;

// A pressed part follows the ride into the valleys of the tooth, and is lifted by higher parts.
fn lower_side(fragment: Fragment, ride: f32) -> f32 {
    let rests = max(fragment.z + min(ride, 0.0), ride);
    return rests - step.sink + fragment.off;
}

@compute @workgroup_size(256)
fn footprint(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    contacts[i].texel = NONE;
    let key = atomicLoad(&keys[i]);
    if key == NONE {
        return;
    }
    let number = key & ((1u << step.bits) - 1u);
    let x = i % step.width;
    let y = i / step.width;
    let fragment = fragment_of(number, x, y);
    let cover = covered(i);
    let wet = totals[i] * step.cells_per_quantum;
    let film = f32(load[1u + fragment.texel]) * step.film_cells_per_quantum;
    let ride = totals[4u * cells() + i];
    let reach = totals[2u * cells() + i] + wet - lower_side(fragment, ride);
    if reach + film <= 0.0 {
        return;
    }
    let depth = clamp(reach, 0.0, wet);
    var fraction = 0.0;
    if wet > 0.0 {
        fraction = depth / wet;
    }
    let thinner = totals[3u * cells() + i];
    let resists = select(0.0, wet, fraction > 0.0);
    let squish = min(SQUISH * (1.0 + EASE * thinner), STABLE / max(resists, 1e-6));
    // Paint in gaps below the bristles stays there.
    let follows = step.follows * (1.0 - SLIP * thinner) * cover * fraction;
    contacts[i] = Contact(
        fragment.texel, cover, fragment.moved, min(reach, wet), fraction, squish, follows,
    );
    note_place(vec2(x, y));
    atomicAdd(&stats[stat(TOUCHED)], 1u);
    atomicAdd(&stats[stat(WET)], u32(totals[i] / 256.0 + 0.5));
    atomicAdd(&stats[stat(THINNER)], u32(totals[i] * thinner / 256.0 + 0.5));
}
