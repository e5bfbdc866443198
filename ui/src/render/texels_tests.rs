//! Tiles as a paint node sends them, and as they are pulled.

use half::f16;
use maulstick_appearance::display::DisplayTile;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_client::frames::texels;

#[test]
fn texels_are_the_planes_of_a_tile() {
    let plane = |from: f32| (0..TILE_CELLS).map(|i| from + i as f32 / 8192.0).collect();
    let tile = DisplayTile {
        rgb: [plane(0.0), plane(1.0), plane(2.0)],
        gloss: plane(0.5),
        wetness: plane(7.0),
        height: plane(0.25),
    };
    let (colour, height) = texels(&tile.to_bytes()).expect("whole");
    let half = |place: usize| f16::from_le_bytes([colour[2 * place], colour[2 * place + 1]]);
    for cell in [0, 1, 64, 4095] {
        let texel = [0, 1, 2, 3].map(|channel| half(4 * cell + channel).to_f32());
        let planes = [&tile.rgb[0], &tile.rgb[1], &tile.rgb[2], &tile.gloss];
        for (got, plane) in texel.iter().zip(planes) {
            assert!((got - plane[cell]).abs() < 2e-3, "{cell}: {texel:?}");
        }
        assert_eq!(height[4 * cell..][..4], tile.height[cell].to_le_bytes());
    }
    assert_eq!(texels(&tile.to_bytes()[1..]), None);
}
