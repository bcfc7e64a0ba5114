//! Tables of measurements for several sizes as sizes of the pattern.

use super::{AXES, file, read_valentina};
use crate::exchange::Companion;
use toile_geometry::Vec2;
use toile_pattern::Evaluation;

/// A table in millimetres: chest 1000 at size 50 and height 176, 40 more a size, hips with the height too.
const TABLE: &str = "<vst><unit>mm</unit><size base='500'/><height base='1760'/><body-measurements>\
    <m name='bust_circ' base='1000' size_increase='40' height_increase='0'/>\
    <m name='hip_circ' base='960' size_increase='24' height_increase='12'/>\
    <m name='@M1' base='100' size_increase='5' height_increase='0'/></body-measurements></vst>";

fn companion() -> Companion {
    Companion {
        name: "GOST.vst".to_owned(),
        bytes: TABLE.as_bytes().to_vec(),
    }
}

#[test]
fn a_table_for_several_sizes_becomes_sizes() {
    let tool = "<point type='endLine' id='9' name='P' basePoint='1' angle='0' length='bust_circ/4+hip_circ+@M1'/>";
    let before = "<measurements>GOST.vst</measurements>";
    let reading =
        read_valentina(&file(before, &format!("{AXES}{tool}"), ""), &[companion()]).unwrap();
    assert_eq!(reading.losses, []);
    let names: Vec<&str> = reading
        .pattern
        .sizes
        .iter()
        .map(|size| size.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "50",
            "44",
            "46",
            "48",
            "52",
            "54",
            "56",
            "50 height 170",
            "50 height 182"
        ]
    );
    assert_eq!(reading.pattern.base_size, Some(reading.pattern.sizes[0].id));
    assert!(reading.guesses.iter().any(|guess| guess.what == "sizes"));
    let point = reading.pattern.sheets[0].point_named("P").unwrap().id;
    for (name, [bust, hips, own]) in [
        ("50", [100.0, 96.0, 10.0]),
        ("44", [88.0, 88.8, 8.5]),
        ("56", [112.0, 103.2, 11.5]),
        ("50 height 182", [100.0, 97.2, 10.0]),
    ] {
        let size = reading
            .pattern
            .sizes
            .iter()
            .find(|size| size.name == name)
            .unwrap();
        let mut pattern = reading.pattern.clone();
        pattern.base_size = Some(size.id);
        let evaluation = Evaluation::new(&pattern, &size.measurements);
        let at = evaluation.point(point).unwrap() * 100.0;
        let wanted = bust / 4.0 + hips + own;
        assert!((at - Vec2::new(wanted, 0.0)).norm() < 1e-9, "{name}: {at}");
    }
}

#[test]
fn a_table_of_one_body_is_one_size() {
    let body = Companion {
        name: "folder/anna.vit".to_owned(),
        bytes: b"<vit><unit>cm</unit><body-measurements><m name='bust_circ' value='90'/></body-measurements></vit>".to_vec(),
    };
    let reading = read_valentina(&file("", AXES, ""), &[body]).unwrap();
    let names: Vec<&str> = reading
        .pattern
        .sizes
        .iter()
        .map(|size| size.name.as_str())
        .collect();
    assert_eq!(names, ["anna"]);
    assert_eq!(reading.guesses, []);
}

#[test]
fn what_no_body_has_stays_in_formulas_and_is_no_measurement_of_the_wearer() {
    // The high hips lie below the hips.
    let rows =
        "<m name='waist_to_highhip_f' base='64'/><m name='waist_to_hip_f' base='37'/></body-m";
    let table = Companion {
        name: "GOST.vst".to_owned(),
        bytes: TABLE.replace("</body-m", rows).into_bytes(),
    };
    let tool = "<point type='endLine' id='9' name='P' basePoint='1' angle='0' length='waist_to_hip_f+hip_circ'/>";
    let before = "<measurements>GOST.vst</measurements>";
    let reading = read_valentina(&file(before, &format!("{AXES}{tool}"), ""), &[table]).unwrap();
    let told: Vec<String> = reading.losses.iter().map(ToString::to_string).collect();
    assert!(
        told.len() == 1 && told[0].contains("waist_to_hip_f of 3.7 cm"),
        "{told:?}"
    );
    let size = &reading.pattern.sizes[0];
    assert!(!size.measurements.contains("hips_line"));
    let evaluation = Evaluation::new(&reading.pattern, &size.measurements);
    let point = reading.pattern.sheets[0].point_named("P").unwrap().id;
    let at = evaluation.point(point).unwrap() * 100.0;
    assert!((at - Vec2::new(3.7 + 96.0, 0.0)).norm() < 1e-9, "{at}");
}
