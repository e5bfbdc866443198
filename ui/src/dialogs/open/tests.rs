use super::*;
use crate::dialogs::browser::folder::Entry;
use crate::dialogs::open::recent::Recent;
use crate::test_support::overlay_bench::picture;

fn entry(name: &str, age: &str) -> Entry {
    Entry {
        name: name.to_owned(),
        is_folder: age.is_empty(),
        age: age.to_owned(),
    }
}

fn dialog() -> OpenPainting {
    let folder = Path::new("/home/ada/Paintings");
    let recent = |name: &str, age: Option<&str>| Recent {
        path: folder.join(name),
        age: age.map(str::to_owned),
    };
    let recent = vec![
        recent("Sea at dawn.maul", Some("2 hours ago")),
        recent(
            "A very long name of a painting that was once begun.maul",
            Some("3 days ago"),
        ),
        recent("Lost.maul", None),
    ];
    let entries = vec![
        entry("studies", ""),
        entry("Birches.maul", "5 days ago"),
        entry("Sea at dawn.maul", "2 hours ago"),
    ];
    let begin = Browser::at("/home/ada/Paintings/", Purpose::Read, PAINTINGS);
    OpenPainting::new(folder, RecentList::of(recent), UnsavedState::default())
        .with(begin.listing(entries, PAINTINGS))
}

#[test]
fn it_looks_as_in_its_picture() {
    picture(
        "files_open",
        [500.0, 480.0],
        dialog,
        |ui, open| {
            let _ = open.show(ui.ctx(), false);
        },
        |_| {},
        |open| open.refused("This painting is open in another rig. Close it there.".into()),
    );
}
