use super::*;
use crate::test_support::overlay_bench::picture;

fn asked(path: &Path, change: impl FnOnce(&mut ExportPicture)) -> Result<ExportOrder, DialogFault> {
    let mut export = ExportPicture::at(path.display().to_string());
    export.follow();
    change(&mut export);
    match export.command(path)? {
        Command::File(FileCommand::Export(order)) => Ok(order),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_name_says_the_format() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, format) in [
        ("a.png", "png"),
        ("a.EXR", "exr"),
        ("a.ora", "ora"),
        ("a.stl", "stl"),
        ("a.glb", "glb"),
    ] {
        let order = asked(&folder.path().join(name), |_| {}).expect("an order");
        assert_eq!((order.format.as_str(), order.bits), (format, 8), "{name}");
    }
    let height = asked(&folder.path().join("a.png"), |export| export.format = 3);
    assert_eq!(height.expect("an order").format, "height");
    let none = asked(&folder.path().join("sea"), |_| {}).expect("an order");
    assert!(none.path.ends_with("/sea.png"));
    let stl = |export: &mut ExportPicture| {
        (export.base_mm, export.exaggeration) = ("1,5".into(), "4".into());
    };
    let solid = asked(&folder.path().join("a.stl"), stl).expect("an order");
    assert!((solid.base_m - 1.5e-3).abs() < 1e-12 && solid.exaggeration == 4.0);
}

#[test]
fn what_cannot_be_written_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |name: &str, change: fn(&mut ExportPicture)| {
        asked(&folder.path().join(name), change).expect_err("refused")
    };
    let none = refused("a.gif", |_| {});
    assert!(matches!(none, DialogFault::NoFormat(ending) if ending == "gif"));
    let beyond = refused("none/a.png", |_| {});
    assert!(matches!(beyond, DialogFault::NoFolder(_)));
    let flat = refused("a.stl", |export| export.base_mm = "0".into());
    assert!(matches!(flat, DialogFault::Flat));
    let none = refused("a.stl", |export| export.exaggeration = "x".into());
    assert!(matches!(none, DialogFault::NoNumber { text, .. } if text == "x"));
}

#[test]
fn it_looks_as_in_its_picture() {
    let dialog = || {
        let path = "/home/ada/Paintings/Birches.png";
        let browser = Browser::at(path, Purpose::Write, ENDINGS);
        ExportPicture::at(String::new()).with(browser.listing(Vec::new(), ENDINGS))
    };
    picture(
        "files_export",
        [500.0, 460.0],
        dialog,
        |ui, export| {
            let _ = export.show(ui.ctx(), false);
        },
        |_| {},
        |export| {
            export.browser.set("/home/ada/Paintings/Birches.stl".into());
        },
    );
}
