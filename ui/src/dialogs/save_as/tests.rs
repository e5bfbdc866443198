use super::*;
use crate::test_support::overlay_bench::picture;

#[test]
fn a_name_is_whole_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let save = |path: &Path| SaveAs::at(String::new()).command(path);
    let Ok(Command::Rig(RigCommand::SaveAs(command::SaveAs { path, replace }))) =
        save(&folder.path().join("sea"))
    else {
        panic!("refused");
    };
    assert!(path.ends_with("/sea.maul") && !replace);
    let none = folder.path().join("none");
    let words = save(&none.join("sea")).expect_err("no folder");
    assert!(words.contains(&none.display().to_string()), "{words}");
    assert!(save(Path::new("/")).is_err(), "no name");
}

#[test]
fn it_looks_as_in_its_picture() {
    let dialog = || {
        let path = "/home/ada/Paintings/Birches 2.maul";
        let browser = Browser::at(path, Purpose::Write, PAINTINGS);
        let mut save_as = SaveAs::at(String::new()).with(browser.listing(Vec::new(), PAINTINGS));
        save_as.found = Some((PathBuf::from(path), false));
        save_as.wrong = Some("There is a file Birches 2.maul already. Write another name.".into());
        save_as
    };
    picture(
        "files_save_as",
        [500.0, 480.0],
        dialog,
        |ui, save_as| {
            let _ = save_as.show(ui.ctx(), false);
        },
        |_| {},
        |save_as| save_as.wrong = None,
    );
}
