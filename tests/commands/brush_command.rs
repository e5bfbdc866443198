//! `maulstick brush` as its users call it.

#[path = "../support/mod.rs"]
mod support;

use support::{Place, fault, has};

/// A spine of two joints, and a stroke of three poses: in the air, pressed, dragged.
const SPINE: &str = "lengths_m = [0.01, 0.008]\nstiffness_nm_per_rad = [3e-4, 1e-4]\nmu = 0.25\n";

const POSES: &str = "t,x,y,z,qx,qy,qz,qw\n\
    0,0,0,0.02,0,0,0,1\n\
    0.1,0,0,0.012,0,0.1,0,0.99498743710662\n\
    0.2,0.004,0,0.012,0,0.1,0,0.99498743710662\n";

/// What `brush solve` is asked for.
fn trial(place: &Place, spine: &str, poses: &str) -> [&'static str; 7] {
    std::fs::write(place.path("s.toml"), spine).expect("written");
    std::fs::write(place.path("p.csv"), poses).expect("written");
    [
        "brush", "solve", "--spine", "s.toml", "--poses", "p.csv", "--json",
    ]
}

#[test]
fn a_spine_is_tried_out() {
    let place = Place::new();
    let said = place.done(&trial(&place, SPINE, POSES)).stdout;
    let rows: Vec<serde_json::Value> = String::from_utf8(said)
        .expect("UTF-8")
        .lines()
        .map(|line| serde_json::from_str(line).expect("a line a pose"))
        .collect();
    assert_eq!(rows.len(), 3);
    for row in &rows {
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        assert!(number(&row["residual"]) <= 1e-6, "{row}");
        assert!(number(&row["penetration_m"]) <= 1e-6 * 0.018, "{row}");
        assert!(row["iterations"].is_u64() && row["converged"] == true);
        for list in ["joints", "theta", "phi"] {
            assert_eq!(row[list].as_array().map(Vec::len), Some(2), "{list}");
        }
        let energy = &row["energy"];
        let parts = ["spring", "friction", "damping"].map(|part| number(&energy[part]));
        let sum: f64 = parts.iter().sum();
        assert!((sum - number(&energy["total"])).abs() <= 1e-15, "{energy}");
        // The segments keep their lengths.
        let at = |joint: usize, axis: usize| number(&row["joints"][joint][axis]);
        let square: f64 = (0..3).map(|axis| (at(1, axis) - at(0, axis)).powi(2)).sum();
        assert!((square.sqrt() - 0.008).abs() < 1e-12);
    }
    let friction = |row: usize| rows[row]["energy"]["friction"].as_f64();
    assert_eq!(friction(1), Some(0.0), "the first touch has none");
    assert!(friction(2) > Some(0.0));
    let table = place.done(&["brush", "solve", "--spine", "s.toml", "--poses", "p.csv"]);
    assert_eq!(String::from_utf8_lossy(&table.stdout).lines().count(), 5);
}

#[test]
fn bad_spines_are_refused_with_their_field() {
    let place = Place::new();
    let refused = |from: &str, to: &str| {
        assert!(SPINE.contains(from), "{from}");
        fault(&place, &trial(&place, &SPINE.replace(from, to), POSES), 2)
    };
    has(
        &refused("mu = ", "mue = "),
        &["unknown key 'mue'", "'mu'", "s.toml:3"],
    );
    has(&refused("0.008", "0.0"), &["lengths_m[1] is 0", "s.toml"]);
    has(&refused("0.008", "-1.0"), &["lengths_m[1] is -1", "s.toml"]);
    has(
        &refused("1e-4", "-1e-4"),
        &["stiffness_nm_per_rad[1] is -0.0001", "s.toml"],
    );
    has(
        &refused(", 1e-4", ""),
        &["stiffness_nm_per_rad", "2 joints"],
    );
    has(&refused("mu = 0.25", "mu = nan"), &["mu is NaN", "s.toml"]);
    has(
        &refused("mu = 0.25", "damping_nm = [0.0]"),
        &["damping_nm", "2 joints"],
    );
    has(
        &refused("mu = 0.25", "c_eta = 2.0"),
        &["c_eta is 2", "0 to 1"],
    );
    let many = |joints: usize| {
        let list = |value: f64| format!("{:?}", vec![value; joints]);
        let (lengths, stiffness) = (list(0.018 / joints as f64), list(1e-3));
        format!("lengths_m = {lengths}\nstiffness_nm_per_rad = {stiffness}\n")
    };
    place.done(&trial(&place, &many(1), POSES));
    place.done(&trial(&place, &many(64), POSES));
    has(
        &fault(&place, &trial(&place, &many(65), POSES), 2),
        &["lengths_m (number) is 65", "1 to 64"],
    );
}

#[test]
fn bad_poses_are_refused_with_their_line() {
    let place = Place::new();
    let refused = |poses: &str| fault(&place, &trial(&place, SPINE, poses), 2);
    has(&refused(""), &["empty", "p.csv:1", "t,x,y,z,qx,qy,qz,qw"]);
    has(
        &refused("0,0,0,0.02,0,0,0,1\n"),
        &["column 1", "p.csv:1", "t,x,y,z,qx,qy,qz,qw"],
    );
    has(&refused("t,x,y,z,qx,qy,qz,qw\n"), &["no poses", "p.csv:1"]);
    let changed = |from: &str, to: &str| {
        assert!(POSES.contains(from), "{from}");
        refused(&POSES.replace(from, to))
    };
    has(
        &changed("0.2,0.004,", "0.2,nan,"),
        &["(x): 'nan' is not finite", "p.csv:4"],
    );
    has(
        &changed("0.2,0.004,", "0.2,a,"),
        &["(x): 'a' is not a number", "p.csv:4"],
    );
    has(&changed("0.2,0.004,", "0.2,"), &["7 columns", "p.csv:4"]);
    has(
        &changed("0.2,0.004,", "0.1,0.004,"),
        &["time does not rise", "p.csv:4"],
    );
    has(
        &changed("0,0.1,0,0.99", "0,0.3,0,0.99"),
        &["qx,qy,qz,qw", "p.csv:3", "unit quaternion"],
    );
    trial(&place, SPINE, POSES);
    has(
        &fault(
            &place,
            &["brush", "solve", "--spine", "s.toml", "--poses", "none.csv"],
            2,
        ),
        &["none.csv", "check the path"],
    );
}

#[test]
fn the_librarys_brushes_are_listed() {
    let place = Place::new();
    let brushes = place.done(&["brush", "list", "--json"]);
    let brushes: serde_json::Value = serde_json::from_slice(&brushes.stdout).expect("JSON");
    let brushes = brushes["brushes"].as_array().expect("brushes");
    let round = brushes.iter().find(|brush| brush["name"] == "round");
    let round = round.expect("the round");
    assert_eq!(
        (&round["spines"], &round["joints"]),
        (&7.into(), &21.into())
    );
    for brush in brushes {
        assert!(
            brush["sizes_mm"]
                .as_array()
                .is_some_and(|sizes| !sizes.is_empty())
        );
        assert!(
            brush["about"]
                .as_str()
                .is_some_and(|about| !about.is_empty())
        );
        for key in ["width_mm", "length_mm", "strips"] {
            assert!(brush[key].as_f64() > Some(0.0), "{key}");
        }
    }
    let table = place.done(&["brush", "list"]);
    let lines = String::from_utf8_lossy(&table.stdout).lines().count();
    assert_eq!(lines, brushes.len());
}
