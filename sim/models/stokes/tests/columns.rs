//! Columns of voxels from inconsistent counts and planes of layers, and back.

use maulstick_canvas::relief::tooth::Tooth;
use maulstick_canvas::window::Area;
use maulstick_canvas::{relief::Relief, store::TileStore, window::Window};
use maulstick_stokes_paint::layer_planes::shape_of;
use maulstick_stokes_paint::layers::Layers;
use maulstick_stokes_paint::voxels::Voxels;
use proptest::prelude::*;

const CELL_M: f64 = 2.5e-4;
/// Quanta that fill a voxel.
const FULL: u32 = 167_772;
const AREA: Area = Area {
    from: [6, 10],
    size: [4, 3],
};

fn window() -> Window {
    let mut store = TileStore::new([64; 2]);
    let all = store.around([0, 0], [64; 2]).expect("a surface");
    let linen = Relief::new(Tooth::new("linen", 1, CELL_M).expect("a tooth"), CELL_M);
    Window::open(&mut store, all, &linen).expect("not leased")
}

fn cells(window: &Window) -> Vec<usize> {
    AREA.rows(window.width()).flatten().collect()
}

/// Writes counts of two paints, and planes of layers.
fn fill(window: &mut Window, counts: &[[u32; 2]], layers: &[(usize, usize, u32)]) {
    for (cell, counts) in cells(window).into_iter().zip(counts) {
        for (slot, count) in counts.iter().enumerate() {
            window.plane_mut(slot)[cell] = *count as f32;
        }
    }
    let cells = cells(window);
    for (place, (slot, layer, count)) in layers.iter().enumerate() {
        let cell = cells[place % cells.len()];
        let bytes = window.own_mut(shape_of(*slot, *layer));
        bytes[4 * cell..4 * cell + 4].copy_from_slice(&(*count as f32).to_le_bytes());
    }
}

fn counts(window: &Window) -> Vec<[f32; 2]> {
    let of = |cell: usize| [0, 1].map(|slot| window.plane(slot).map_or(0.0, |plane| plane[cell]));
    cells(window).into_iter().map(of).collect()
}

/// True if no voxel is overfull, and none that is paint has room for the paint above it.
fn is_packed(voxels: &Voxels) -> bool {
    (0..AREA.cells()).all(|column| {
        let totals: Vec<u32> = voxels
            .column(column)
            .map(|voxel| voxels.total(voxel))
            .collect();
        let rooms = std::iter::once(voxels.lowest_room(column)).chain(std::iter::repeat(FULL));
        let mut pairs = totals.windows(2).zip(rooms);
        pairs.all(|(total, room)| {
            let has_room = 2 * total[0] >= room && total[0] < room;
            total[0] <= room && !(has_room && total[1] > 0)
        })
    })
}

proptest! {
    #[test]
    fn a_column_has_no_voids(
        all in prop::collection::vec(prop::array::uniform2(400_000u32..2_000_000), 12),
        layers in prop::collection::vec((0usize..2, 1usize..20, 0u32..400_000), 0..40),
        column in 0usize..12,
    ) {
        let mut window = window();
        fill(&mut window, &all, &layers);
        let mut voxels = Voxels::read(&window, AREA, Layers::of(&window, CELL_M), &[0, 1]);
        prop_assert!(is_packed(&voxels));
        // A void of a quantum, and an excess of a quantum.
        let bottom = voxels.bottom(column);
        let above = bottom + voxels.volume.grid.stride(2);
        prop_assume!(voxels.total(bottom) == voxels.lowest_room(column) && voxels.total(above) > 0);
        let paint = usize::from(voxels.volume.paints[0][bottom] == 0);
        voxels.volume.paints[paint][bottom] -= 1;
        prop_assert!(!is_packed(&voxels));
        voxels.volume.paints[paint][bottom] += 2;
        prop_assert!(!is_packed(&voxels));
        voxels.pack();
        prop_assert!(is_packed(&voxels));
    }

    #[test]
    fn what_is_read_is_written_to_the_quantum(
        all in prop::collection::vec(prop::array::uniform2(0u32..2_000_000), 12),
        layers in prop::collection::vec((0usize..2, 1usize..20, 0u32..400_000), 0..40),
    ) {
        let mut window = window();
        fill(&mut window, &all, &layers);
        let before = counts(&window);
        let voxels = Voxels::read(&window, AREA, Layers::of(&window, CELL_M), &[0, 1]);
        voxels.write(&mut window);
        prop_assert_eq!(counts(&window), before);
        // Read again, each voxel is the same.
        let again = Voxels::read(&window, AREA, Layers::of(&window, CELL_M), &[0, 1]);
        let same = |paint: usize| {
            let voxel = |voxels: &Voxels| -> Vec<u32> {
                let columns = (0..AREA.cells()).flat_map(|column| voxels.column(column).take(12).collect::<Vec<_>>());
                columns.map(|voxel| voxels.volume.paints[paint][voxel]).collect()
            };
            voxel(&voxels) == voxel(&again)
        };
        let alike = voxels.volume.grid == again.volume.grid;
        prop_assert!(!alike || same(0) && same(1));
    }

    #[test]
    fn what_others_change_is_taken_from_the_top(
        all in prop::collection::vec(prop::array::uniform2(0u32..2_000_000), 12),
        then in prop::collection::vec(prop::array::uniform2(0u32..2_000_000), 12),
    ) {
        let mut window = window();
        fill(&mut window, &all, &[]);
        let mut voxels = Voxels::read(&window, AREA, Layers::of(&window, CELL_M), &[0, 1]);
        let lowest: Vec<u32> = (0..AREA.cells()).map(|column| voxels.total(voxels.bottom(column))).collect();
        fill(&mut window, &then, &[]);
        let after = counts(&window);
        voxels.follow(&window);
        voxels.write(&mut window);
        prop_assert_eq!(counts(&window), after);
        for (column, [before, now]) in all.iter().zip(&then).map(|(a, b)| [a, b]).enumerate() {
            // A column that only grew keeps its lowest voxel.
            if before[0] <= now[0] && before[1] <= now[1] && lowest[column] >= voxels.volume.capacity {
                prop_assert_eq!(voxels.total(voxels.bottom(column)), lowest[column]);
            }
        }
    }

    #[test]
    fn what_is_set_aside_comes_back(
        all in prop::collection::vec(prop::array::uniform2(0u32..400_000), 12),
        stain in 0.0f32..300_000.0,
    ) {
        let mut window = window();
        fill(&mut window, &all, &[]);
        let mut voxels = Voxels::read(&window, AREA, Layers::of(&window, CELL_M), &[0, 1]);
        let before = voxels.volume.counts();
        let aside = voxels.set_aside(stain, 0.8);
        let some: u64 = aside.iter().map(|count| u64::from(*count)).sum();
        prop_assert_eq!(voxels.volume.counts().iter().sum::<u64>() + some, before.iter().sum::<u64>());
        voxels.put_back(&aside);
        prop_assert_eq!(voxels.volume.counts(), before);
    }
}
