use std::collections::{BTreeMap, BTreeSet};

use maulstick_types::FrameTileView;

use super::*;

/// A paint node whose surface has this many tiles at full detail.
struct Node {
    grid: [u32; 2],
    epoch: u32,
    look: u64,
    version: u64,
    painted: BTreeMap<(u32, u32), u64>,
    /// Tiles of a reply at most.
    most: usize,
}

/// A view's sheets: what version of which tile they hold.
#[derive(Default)]
struct View {
    plan: TilePlanner,
    tiles: BTreeMap<(u64, u32, u32), (u64, u64)>,
    sent: usize,
}

impl Node {
    fn new(grid: [u32; 2]) -> Self {
        Self {
            grid,
            epoch: 9,
            look: 1,
            version: 0,
            painted: BTreeMap::new(),
            most: 20,
        }
    }

    fn paint(&mut self, x: u32, y: u32) {
        self.version += 1;
        self.painted.insert((x, y), self.version);
    }

    fn grid_at(&self, level: u32) -> [u32; 2] {
        self.grid.map(|tiles| tiles.div_ceil(1 << level))
    }

    /// As the paint node counts: bare tiles first, one after the other.
    fn version_of(&self, level: u32, x: u32, y: u32) -> u64 {
        let inside = |at: u32, tile: u32| at >> level == tile;
        let painted = self
            .painted
            .iter()
            .filter(|((a, b), _)| inside(*a, x) && inside(*b, y));
        match painted.map(|(_, version)| *version).max() {
            Some(version) => (1 << 32) + version,
            None => u64::from(y * self.grid_at(level)[0] + x) + 1,
        }
    }

    /// Answers, and gives the tiles with their versions.
    fn answer(&self, asked: &Asked, of: (u32, u64)) -> (FrameView<'static>, Vec<(u32, u32, u64)>) {
        let grid = self.grid_at(asked.level);
        let since = if of == (self.epoch, self.look) {
            asked.since
        } else {
            0
        };
        let mut events = Vec::new();
        for y in asked.tiles.from[1]..asked.tiles.to[1].min(grid[1]) {
            for x in asked.tiles.from[0]..asked.tiles.to[0].min(grid[0]) {
                let version = self.version_of(asked.level, x, y);
                if version > since {
                    events.push((version, x, y));
                }
            }
        }
        events.sort_unstable();
        let more = events.len() > self.most;
        events.truncate(self.most);
        let version = match events.last() {
            Some((version, ..)) if more => *version,
            _ => (1 << 32) + self.version,
        };
        let reply = FrameView {
            surface: 0,
            epoch: self.epoch,
            version,
            level: asked.level,
            cells: grid.map(|tiles| tiles * 64),
            journal: 0,
            holds: Vec::new(),
            more,
            tiles: events.iter().map(|(_, x, y)| tile(*x, *y)).collect(),
            look: self.look,
        };
        (reply, events.iter().map(|(v, x, y)| (*x, *y, *v)).collect())
    }
}

impl View {
    /// One question and its answer.
    fn turn(&mut self, node: &Node, wanted: &Wanted) -> Asked {
        let asked = self.plan.next(wanted);
        let (reply, tiles) = node.answer(&asked, self.plan.of());
        self.sent += tiles.len();
        if self.plan.take(&asked, &reply) {
            let atlas = self.plan.atlas(asked.part);
            for (x, y, version) in tiles {
                self.tiles
                    .insert((atlas.number, x, y), (version, reply.look));
            }
        }
        asked
    }

    /// Until it waits for news.
    fn settle(&mut self, node: &Node, wanted: &Wanted) {
        for _ in 0..400 {
            let asked = self.turn(node, wanted);
            if asked.waits && !self.plan.is_late(&asked, wanted) {
                return;
            }
        }
        panic!("it does not settle: {:?}", self.plan);
    }

    /// True if a sheet holds the newest version of every tile that it lists.
    fn is_right(&self, node: &Node, part: Part) -> bool {
        let atlas = self.plan.atlas(part);
        let held = atlas.held;
        (held.from[1]..held.to[1]).all(|y| {
            (held.from[0]..held.to[0]).all(|x| {
                let version = node.version_of(atlas.level, x, y);
                self.tiles.get(&(atlas.number, x, y)) == Some(&(version, node.look))
            })
        })
    }
}

fn tile(x: u32, y: u32) -> FrameTileView<'static> {
    FrameTileView { x, y, planes: &[] }
}

fn rect(from: [u32; 2], to: [u32; 2]) -> TileRect {
    TileRect { from, to }
}

fn wanted(level: u32, tiles: TileRect) -> Wanted {
    Wanted {
        level,
        tiles,
        room: [12, 10],
        base: Some(3),
        base_tiles: [8, 8],
        wet: false,
    }
}

#[test]
fn a_view_that_moves_gets_each_tile_once_and_all_that_is_painted() {
    let mut node = Node::new([64, 64]);
    let mut view = View::default();
    let mut at = wanted(0, rect([10, 10], [20, 18]));
    view.settle(&node, &at);
    assert_eq!(view.plan.atlas(Part::Detail).held, at.tiles);
    assert_eq!(view.sent, 80 + 64, "the detail and the base");
    let number = view.plan.atlas(Part::Detail).number;
    for (from, to) in [
        ([12, 10], [22, 18]),
        ([11, 13], [21, 21]),
        ([9, 12], [21, 22]),
        ([30, 40], [40, 48]),
    ] {
        node.paint(from[0] + 1, from[1] + 1);
        node.paint(to[0] - 1, to[1] - 1);
        let (before, sent) = (view.plan.atlas(Part::Detail).held, view.sent);
        at.tiles = rect(from, to);
        view.settle(&node, &at);
        let now = view.plan.atlas(Part::Detail);
        assert_eq!((now.held, now.number), (at.tiles, number));
        assert!(view.is_right(&node, Part::Detail));
        let new: u32 = at
            .tiles
            .without(&before)
            .iter()
            .map(|part| part.size()[0] * part.size()[1])
            .sum();
        let sent = view.sent - sent;
        assert!(
            sent >= new as usize && sent <= new as usize + 6,
            "{sent} for {new}"
        );
        node.paint(from[0] + 2, from[1] + 2);
        view.turn(&node, &at);
        view.turn(&node, &at);
        assert!(view.is_right(&node, Part::Detail));
    }
    node.paint(30, 40);
    assert!(!view.is_right(&node, Part::Detail), "a fault would pass");
}

#[test]
fn another_level_is_a_sheet_of_its_own_that_says_what_it_holds_when_it_is_whole() {
    let node = Node::new([64, 64]);
    let mut view = View::default();
    view.settle(&node, &wanted(0, rect([10, 10], [20, 18])));
    let old = view.plan.atlas(Part::Detail);
    let next = wanted(1, rect([4, 4], [12, 10]));
    let mut parts = 0;
    while view.plan.atlas(Part::Detail).held.is_empty()
        || view.plan.atlas(Part::Detail).number == old.number
    {
        view.turn(&node, &next);
        parts += 1;
        assert!(parts < 20);
    }
    assert!(parts > 2, "it came in parts");
    assert_eq!(view.plan.atlas(Part::Detail).held, next.tiles);
    assert!(view.is_right(&node, Part::Detail));
}

#[test]
fn a_first_picture_comes_although_the_view_moves_meanwhile() {
    let node = Node::new([64, 64]);
    let mut view = View::default();
    let mut turns = 0;
    while view.plan.atlas(Part::Detail).held.is_empty() {
        let x = 10 + turns / 4;
        view.turn(&node, &wanted(0, rect([x, 10], [x + 10, 18])));
        turns += 1;
        assert!(turns < 20, "it begins again and again");
    }
    view.settle(&node, &wanted(0, rect([14, 10], [24, 18])));
    assert!(view.is_right(&node, Part::Detail));
}

#[test]
fn the_base_follows_when_the_paint_rests_and_at_once_where_it_is_seen() {
    let mut node = Node::new([64, 64]);
    let mut view = View::default();
    let at = wanted(0, rect([10, 10], [20, 18]));
    view.settle(&node, &at);
    let mut bases = 0;
    for i in 0..64 {
        node.paint(11 + i % 8, 12);
        bases += u32::from(view.turn(&node, &at).part == Part::Base);
    }
    assert!((2..=6).contains(&bases), "{bases} of 64 questions");
    for _ in 0..4 {
        view.turn(&node, &at);
    }
    assert!(view.is_right(&node, Part::Base) && view.is_right(&node, Part::Detail));
    node.paint(40, 40);
    assert!(!view.is_right(&node, Part::Base), "a fault would pass");
    let far = wanted(0, rect([36, 36], [46, 44]));
    let parts: BTreeSet<_> = (0..2)
        .map(|_| view.turn(&node, &far).part as usize)
        .collect();
    assert_eq!(parts.len(), 2, "both are asked for in turns");
    assert!(view.is_right(&node, Part::Base));
}

#[test]
fn a_surface_that_is_wanted_whole_has_no_base() {
    let node = Node::new([8, 6]);
    let mut view = View::default();
    let whole = Wanted {
        level: 0,
        tiles: TileRect::up_to([8, 6]),
        room: [8, 6],
        ..Wanted::default()
    };
    view.settle(&node, &whole);
    for _ in 0..40 {
        assert_eq!(view.turn(&node, &whole).part, Part::Detail);
    }
    assert_eq!(view.sent, 48);
}

#[test]
fn another_start_and_another_light_bring_all_anew() {
    let mut node = Node::new([64, 64]);
    let mut view = View::default();
    let at = wanted(0, rect([10, 10], [20, 18]));
    view.settle(&node, &at);
    let old = view.plan.atlas(Part::Detail);
    node.look += 1;
    for _ in 0..60 {
        view.turn(&node, &at);
    }
    assert_eq!(view.plan.atlas(Part::Detail), old, "in the same picture");
    assert!(view.is_right(&node, Part::Detail) && view.is_right(&node, Part::Base));
    // The light changes while a strip is on its way.
    let moved = wanted(0, rect([12, 10], [22, 18]));
    node.most = 7;
    view.turn(&node, &moved);
    node.look += 1;
    assert!(!view.is_right(&node, Part::Base), "a fault would pass");
    for _ in 0..90 {
        view.turn(&node, &moved);
    }
    assert!(view.is_right(&node, Part::Detail) && view.is_right(&node, Part::Base));
    node.epoch += 1;
    node.painted.clear();
    node.version = 0;
    view.settle(&node, &moved);
    for _ in 0..60 {
        view.turn(&node, &moved);
    }
    assert_ne!(view.plan.atlas(Part::Detail).number, old.number);
    assert!(view.is_right(&node, Part::Detail) && view.is_right(&node, Part::Base));
}

#[test]
fn a_question_that_waits_is_late_when_the_view_wants_something_else() {
    let node = Node::new([64, 64]);
    let mut view = View::default();
    let at = wanted(0, rect([10, 10], [20, 18]));
    view.settle(&node, &at);
    let asked = std::iter::repeat_with(|| view.turn(&node, &at))
        .find(|asked| asked.waits)
        .expect("it waits");
    assert!(!view.plan.is_late(&asked, &at));
    assert!(
        view.plan
            .is_late(&asked, &wanted(0, rect([11, 10], [21, 18])))
    );
    assert!(view.plan.is_late(&asked, &wanted(1, at.tiles)));
}

#[test]
fn wet_paint_that_is_to_be_told_is_another_picture() {
    let tiles = TileRect::up_to([4, 4]);
    let (dry, mut plan) = (wanted(0, tiles), TilePlanner::default());
    plan.next(&dry);
    let first = plan.atlas(Part::Detail).number;
    plan.next(&dry);
    assert_eq!(plan.atlas(Part::Detail).number, first);
    let wet = Wanted { wet: true, ..dry };
    plan.next(&wet);
    let atlas = plan.atlas(Part::Detail);
    assert!(atlas.wet && atlas.number > first, "{atlas:?}");
}
