//! What a knife or a reader takes literally: notches in the allowance, at corners on both cut
//! lines, holes of pieces that are no cloth.

use super::{case, toile, words};
use serde_json::Value;
use std::path::Path;

fn run(folder: &Path, arguments: &[&str]) -> String {
    let output = toile(folder, arguments);
    assert!(output.status.success(), "{}", words(&output.stderr));
    words(&output.stdout)
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// A folder for what is written.
fn room(name: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    folder.to_string_lossy().into_owned()
}

/// The polylines of a layer of a DXF (mm).
fn layer(dxf: &str, name: &str) -> Vec<Vec<[f64; 2]>> {
    let lines: Vec<&str> = dxf.lines().map(str::trim).collect();
    let mut found: Vec<Vec<[f64; 2]>> = Vec::new();
    let (mut kind, mut own, mut x) = ("", false, 0.0);
    for pair in lines.chunks(2) {
        match (pair[0], pair[1]) {
            ("0", value) => kind = value,
            ("8", value) if kind == "POLYLINE" => {
                own = value == name;
                if own {
                    found.push(Vec::new());
                }
            }
            ("10", value) if kind == "VERTEX" && own => x = value.parse().unwrap(),
            ("20", value) if kind == "VERTEX" && own => {
                let y: f64 = value.parse().unwrap();
                found.last_mut().unwrap().push([x, y]);
            }
            _ => {}
        }
    }
    found
}

/// Whether a place lies in the box of a ring, and more than a tenth of a millimetre from its sides:
/// the pieces here are rectangles.
fn inside(ring: &[[f64; 2]], at: [f64; 2]) -> bool {
    (0..2).all(|axis| {
        let low = ring.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let high = ring.iter().map(|p| p[axis]).fold(0.0, f64::max);
        (low + 0.1..high - 0.1).contains(&at[axis])
    })
}

fn notched(change: impl Fn(String) -> String, name: &str) -> (String, String) {
    let folder = room(name);
    std::fs::create_dir_all(&folder).unwrap();
    let given = std::fs::read_to_string(case("notches-cut-into-cloth").join("p.toile.json"));
    std::fs::write(
        Path::new(&folder).join("p.toile.json"),
        change(given.unwrap()),
    )
    .unwrap();
    let nest = ["nest", "p.toile.json", "--width", "150cm", "--time", "1s"];
    let write = ["--write", "dxf,plt", "--out", "out"];
    let said = run(Path::new(&folder), &[&nest[..], &write].concat());
    let dxf = std::fs::read_to_string(Path::new(&folder).join("out/marker.dxf"));
    (said, dxf.unwrap())
}

#[test]
fn notches_are_cut_in_the_allowance_or_drawn() {
    let (said, dxf) = notched(|text| text, "knife-allowance");
    let sewn = layer(&dxf, "SEW");
    let cut = layer(&dxf, "NOTCH");
    // One between corners, two at a corner; the corner where an edge has no allowance is drawn.
    assert_eq!(cut.len(), 3, "{cut:?}");
    assert!(
        cut.iter().flatten().all(|p| !inside(&sewn[0], *p)),
        "{cut:?}"
    );
    assert_eq!(layer(&dxf, "LINE").len(), 1);
    assert!(
        said.contains("notch \"at corner 1\" is drawn on the seam line"),
        "{said}"
    );
}

#[test]
fn notches_of_doll_clothes_are_shorter_than_their_allowance() {
    let narrow = |text: String| {
        text.replace("\"allowance\": 1,", "\"allowance\": 0.3,")
            .replace("\"allowance\": 2\n", "\"allowance\": 0.3\n")
            .replace("\"allowance\": 0\n", "\"allowance\": 0.3\n")
    };
    let (said, dxf) = notched(narrow, "knife-doll");
    let (sewn, cut) = (layer(&dxf, "SEW"), layer(&dxf, "NOTCH"));
    assert_eq!(cut.len(), 5, "{cut:?}");
    for line in &cut {
        let [a, b] = [line[0], line[1]];
        let length = (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!((length - 1.8).abs() < 1e-3, "{length}");
        assert!(line.iter().all(|p| !inside(&sewn[0], *p)));
    }
    assert!(said.contains("are cut only 1.8 mm deep"), "{said}");
}

#[test]
fn without_any_allowance_no_notch_is_cut() {
    let none = |text: String| {
        text.replace("\"allowance\": 1,", "\"allowance\": 0,")
            .replace("\"allowance\": 2\n", "\"allowance\": 0\n")
    };
    let (said, dxf) = notched(none, "knife-none");
    assert!(layer(&dxf, "NOTCH").is_empty());
    assert_eq!(layer(&dxf, "LINE").len(), 3);
    assert!(
        said.contains("are drawn on the seam line and not cut"),
        "{said}"
    );
    let plot = Path::new(&room("unused")).with_file_name("knife-none/out/marker.plt");
    let plot = std::fs::read_to_string(plot).unwrap();
    let cut = plot.split("SP1;").nth(1).unwrap();
    let cut = cut.split("SP").next().unwrap();
    assert_eq!(cut.matches("PD").count(), 1, "the cut line alone: {cut}");
}

#[test]
fn a_notch_at_a_corner_stands_on_both_cut_lines() {
    let said = run(
        &case("notch-at-a-corner"),
        &["check", "p.toile.json", "--json"],
    );
    let notches = json(&said)["pieces"][0]["notches"].clone();
    let of = |name: &str| -> Vec<(String, [f64; 2], f64)> {
        let own = notches
            .as_array()
            .unwrap()
            .iter()
            .filter(|n| n["name"] == name);
        let place = |n: &Value| {
            let cut = [0, 1].map(|k| n["cut_mm"][k].as_f64().unwrap());
            let edge = n["edge"].as_str().unwrap().to_owned();
            (edge, cut, n["depth_mm"].as_f64().unwrap())
        };
        own.map(place).collect()
    };
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-6;
    let corner = of("at corner 3");
    assert_eq!(corner.len(), 2, "{corner:?}");
    for (edge, place) in [("e2", [0.0, 320.0]), ("e3", [-10.0, 300.0])] {
        let own = corner.iter().find(|n| n.0 == edge).unwrap();
        assert!(near(own.1, place) && (own.2 - 6.0).abs() < 1e-9, "{own:?}");
    }
    // An edge without an allowance beside it: the corner of the cloth, and the seam line.
    let bare = of("at corner 1");
    let places: Vec<_> = bare.iter().map(|n| (n.0.as_str(), n.1)).collect();
    assert_eq!(places.len(), 2, "{bare:?}");
    assert!(
        places
            .iter()
            .any(|p| p.0 == "e0" && near(p.1, [200.0, -10.0])),
        "{bare:?}"
    );
    assert!(
        places
            .iter()
            .any(|p| p.0 == "e1" && near(p.1, [200.0, 0.0])),
        "{bare:?}"
    );
    assert_eq!(of("mid").len(), 1);
}

/// The efficiency told, and that of the area of cloth in `toile check` over the fabric's.
fn told_and_right(folder: &Path, (file, width): (&str, f64), room: &str) -> (f64, f64) {
    let across = format!("{width}m");
    let nest = [
        "nest", file, "--width", &across, "--time", "1s", "--write", "json", "--out", room,
    ];
    let said = run(folder, &nest);
    assert!(said.contains("no piece is laid into its holes"), "{said}");
    let marker = std::fs::read_to_string(Path::new(room).join("marker.json")).unwrap();
    let marker = json(&marker);
    let checked = json(&run(folder, &["check", file, "--json"]));
    let pieces = checked["pieces"].as_array().unwrap();
    let cloth = pieces
        .iter()
        .map(|p| p["cut"]["area_cm2"].as_f64().unwrap());
    let length = marker["length"].as_f64().unwrap();
    let right = 1e-4 * cloth.sum::<f64>() / (width * length);
    (marker["efficiency"].as_f64().unwrap(), right)
}

#[test]
fn holes_are_not_counted_as_cloth() {
    let folder = case("holes-counted-as-cloth");
    let made = room("knife-holes");
    let (told, right) = told_and_right(&folder, ("holes.toile.json", 0.42), &made);
    assert!((told - right).abs() < 1e-9, "{told} {right}");
    let checked = run(&folder, &["check", &format!("{made}/marker.json")]);
    assert!(checked.contains("no faults"), "{checked}");
}

#[test]
fn the_poncho_uses_the_cloth_that_it_is_made_of() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    let (told, right) = told_and_right(&folder, ("poncho.toile.json", 1.5), &room("knife-poncho"));
    assert!((told - right).abs() < 1e-6, "{told} {right}");
}
