//! Pieces, damaged files, and the shared samples.

use super::{AXES, assert_near, evaluated, file, place, read, read_valentina};
use crate::exchange::Companion;
use toile_pattern::{CurveRule, NotchKind, Number, OperationKind};

/// A square of 10 cm whose right side is cut out of an arc, with widths, a passmark and a mirror line.
const PIECE: &str = "<modeling><point id='101' idObject='1' type='modeling'/>\
    <point id='102' idObject='2' type='modeling'/><point id='103' idObject='3' type='modeling'/>\
    <arc id='104' idObject='5' type='modeling'/></modeling>\
    <pieces><piece id='200' name='front' seamAllowance='1' width='1.5' mx='3' my='4'>\
    <data quantity='2'/><grainline visible='true' rotation='45'/><mirrorLine p1='101' p2='103'/><nodes>\
    <node type='NodePoint' idObject='103'/>\
    <node type='NodePoint' idObject='101' after='2' passmark='1' passmarkLine='vMark'/>\
    <node type='NodePoint' idObject='102' before='2'/>\
    <node type='NodeArc' idObject='104' reverse='0'/></nodes></piece></pieces>";

#[test]
fn a_piece_becomes_a_panel_with_all_that_it_says() {
    let arc = "<arc type='simple' id='5' center='1' radius='10' angle1='0' angle2='90'/>";
    let reading = read(&file("", &format!("{AXES}{arc}"), PIECE));
    assert_eq!(reading.losses, []);
    let panel = &reading.pattern.panels[0];
    let outline = panel.outline().unwrap();
    assert_eq!(outline.edges.len(), 3);
    let evaluation = evaluated(&reading);
    assert_eq!(evaluation.diagnostics(), []);
    let paths = outline
        .edges
        .iter()
        .map(|edge| evaluation.edge(edge.id).unwrap());
    let area: f64 = paths
        .flat_map(|path| path.curves())
        .map(|curve| curve.swept_area())
        .sum();
    // Twice the area is swept.
    let quarter = std::f64::consts::PI * 0.1 * 0.1 / 2.0;
    assert!((area - quarter).abs() < 1e-12, "{area}");
    assert_eq!(panel.allowance, Number::Value(0.015));
    let own: Vec<_> = outline
        .edges
        .iter()
        .filter_map(|edge| edge.allowance.clone())
        .collect();
    assert_eq!(own, [Number::Value(0.02)]);
    assert_eq!(panel.cut.quantity, 2);
    assert_eq!(panel.grain, Number::Value(45_f64.to_radians()));
    assert_eq!(panel.on_table, Some([0.03, -0.04]));
    assert_eq!(panel.notches.len(), 1);
    assert_eq!(panel.notches[0].kind, NotchKind::V);
    assert!(matches!(
        panel.operations[0].kind,
        OperationKind::Fold { .. }
    ));
    let stage = evaluation.last_stage(panel);
    assert!(stage.is_some(), "the fold is done");
}

#[test]
fn a_clockwise_outline_is_turned_and_a_curve_cut_to_its_neighbours() {
    let tools = "<arc type='simple' id='5' center='1' radius='5' angle1='0' angle2='180'/>\
        <point type='cutArc' id='6' name='C' arc='5' length='Arc_O_5/2'/>";
    let modeling = "<modeling><point id='101' idObject='1' type='modeling'/>\
        <point id='102' idObject='6' type='modeling'/><arc id='104' idObject='5' type='modeling'/></modeling>";
    let pieces = "<details><detail id='200' name='d' supplement='0' width='1'>\
        <node type='NodePoint' idObject='101'/><node type='NodePoint' idObject='102'/>\
        <node type='NodeArc' idObject='104' reverse='1'/></detail></details>";
    let reading = read(&file(
        "",
        &format!("{AXES}{tools}"),
        &format!("{modeling}{pieces}"),
    ));
    assert_eq!(reading.losses, []);
    let evaluation = evaluated(&reading);
    let outline = reading.pattern.panels[0].outline().unwrap();
    let paths = outline
        .edges
        .iter()
        .map(|edge| evaluation.edge(edge.id).unwrap());
    let area: f64 = paths
        .flat_map(|path| path.curves())
        .map(|curve| curve.swept_area())
        .sum();
    let quarter = std::f64::consts::PI * 0.05 * 0.05 / 2.0;
    assert!((area - quarter).abs() < 1e-12, "{area}");
    assert_eq!(reading.pattern.panels[0].allowance, Number::ZERO);
    let curves = &reading.pattern.sheets[0].curves;
    assert!(
        curves
            .iter()
            .any(|curve| matches!(curve.rule, CurveRule::Arc { .. }))
    );
}

#[test]
fn what_hangs_on_an_unknown_tool_is_left_out_by_name_and_the_rest_read() {
    let tools = "<point type='fromTheFuture' id='7' name='F'/>\
        <point type='endLine' id='8' name='G' basePoint='7' angle='0' length='1'/>\
        <point type='endLine' id='9' name='P' basePoint='2' angle='0' length='1'/>\
        <point type='endLine' id='10' name='H' basePoint='2' angle='0' length='log(2)'/>\
        <point type='endLine' id='11' name='I' basePoint='2' angle='0' length='Line_O_Nowhere'/>\
        <point type='endLine' id='12' basePoint='99' name='J' angle='0' length='1'/>\
        <point type='endLine' id='13' name='K' basePoint='13' angle='0' length='(1'/>";
    let reading = read(&file("", &format!("{AXES}{tools}"), ""));
    assert_near(place(&reading, "P"), [11.0, 0.0], "P");
    let told: Vec<String> = reading
        .losses
        .iter()
        .map(|loss| loss.what.clone())
        .collect();
    for name in ["F", "G", "H", "I", "J", "K"] {
        assert!(
            told.iter().any(|what| what.contains(&format!("{name:?}"))),
            "{name}: {told:?}"
        );
    }
    assert_eq!(reading.losses.len(), 6);
}

#[test]
fn damaged_files_are_refused_with_place_and_remedy() {
    for (text, place) in [
        ("", "line 1"),
        ("<pattern><unit>cm</unit>", "line 1"),
        ("<vit><unit>cm</unit></vit>", "the whole file"),
        ("<pattern><unit>ell</unit></pattern>", "unit"),
        ("<pattern><unit>cm</unit></pattern>", "the whole file"),
    ] {
        let refused = read_valentina(text, &[]).err().unwrap();
        assert_eq!(refused.place, place, "{text}");
        assert!(!refused.hint.is_empty());
    }
    let companion = Companion {
        name: "b.vit".to_owned(),
        bytes: b"<vit><m name='a'".to_vec(),
    };
    let text = file("", AXES, "");
    let refused = read_valentina(&text, &[companion]).err().unwrap();
    assert!(refused.place.starts_with("b.vit, line"), "{refused}");
}

/// The folder of shared samples, if it is here.
pub(super) fn samples() -> Option<std::path::PathBuf> {
    let start = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let mut above = start.ancestors().map(|folder| folder.join("shared/data"));
    above.find(|folder| folder.join("valentina").is_dir())
}

#[test]
#[allow(clippy::print_stdout)]
fn shared_samples_are_read_with_all_their_pieces() {
    let Some(folder) = samples() else {
        println!("skipped: there is no folder of shared samples");
        return;
    };
    for (file, body, pieces) in [
        (
            "valentina/MaleShirt.val",
            Some("valentina/MaleShirt.vit"),
            17,
        ),
        ("valentina/Keiko_skirt.val", Some("valentina/keiko.vit"), 2),
        ("valentina/Sleeve.val", None, 1),
        ("valentina/TestDart.val", None, 1),
        ("seamly/male_shirt.sm2d", Some("seamly/male_shirt.smis"), 17),
        ("seamly/trousers.sm2d", Some("seamly/trousers.smis"), 11),
    ] {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let companions = body.map(|body| Companion {
            name: body.to_owned(),
            bytes: std::fs::read(folder.join(body)).unwrap(),
        });
        let companions: Vec<Companion> = companions.into_iter().collect();
        let reading = read_valentina(&text, &companions).unwrap();
        assert_eq!(reading.pattern.panels.len(), pieces, "{file}");
        let evaluation = evaluated(&reading);
        for panel in &reading.pattern.panels {
            let stage = evaluation.last_stage(panel);
            assert!(stage.is_some(), "{file}: {} is not closed", panel.name);
        }
    }
}
