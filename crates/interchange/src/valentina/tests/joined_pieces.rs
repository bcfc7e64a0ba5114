//! Pieces joined along an edge each, with places worked out by hand.

use super::{AXES, ValentinaReading, evaluated, file, read};
use toile_geometry::{Curve, Vec2};

/// A triangle 10 cm wide and high, O, X, Y, and one of 4 and 3 cm on a second drawing, A, B, C, with an arc of a
/// quarter of a circle between B and C on request; then a tool and the nodes of the united piece.
fn joined(arc: &str, tool: &str, nodes: &[(&str, u32)]) -> ValentinaReading {
    let first = "<modeling><point id='101' idObject='1'/><point id='102' idObject='2'/>\
        <point id='103' idObject='3'/></modeling>";
    let nodes: String = nodes
        .iter()
        .map(|(kind, id)| format!("<node type='Node{kind}' idObject='{id}'/>"))
        .collect();
    let second = format!(
        "<draw name='second'><calculation>\
         <point type='single' id='11' name='A' x='30' y='0'/>\
         <point type='endLine' id='12' name='B' basePoint='11' angle='0' length='4'/>\
         <point type='endLine' id='13' name='C' basePoint='11' angle='90' length='3'/>{arc}\
         </calculation><modeling>\
         <point id='201' idObject='11'/><point id='202' idObject='12'/><point id='203' idObject='13'/>\
         <arc id='204' idObject='14'/>{tool}</modeling>\
         <details><detail id='300' name='d' version='2'><nodes>{nodes}</nodes></detail></details>\
         </draw></pattern>"
    );
    read(&file("", AXES, first).replace("</pattern>", &second))
}

/// The corners of the united piece (cm), and its area (cm2).
fn outline(reading: &ValentinaReading) -> (Vec<Vec2>, f64) {
    let evaluation = evaluated(reading);
    let edges = reading.pattern.panels[0].outline().unwrap().edges.iter();
    let paths: Vec<_> = edges
        .map(|edge| evaluation.edge(edge.id).unwrap())
        .collect();
    let swept = paths
        .iter()
        .flat_map(|path| path.curves())
        .map(Curve::swept_area);
    let area = swept.sum::<f64>() / 2.0 * 1e4;
    (
        paths
            .iter()
            .map(|path| path.curves()[0].start() * 100.0)
            .collect(),
        area,
    )
}

fn assert_corners(reading: &ValentinaReading, wanted: &[[f64; 2]], area: f64) {
    assert_eq!(reading.losses, []);
    let (corners, found) = outline(reading);
    assert!((found - area).abs() < 1e-6, "{found}, not {area}");
    assert_eq!(corners.len(), wanted.len(), "{corners:?}");
    for (corner, wanted) in corners.iter().zip(wanted) {
        assert!((corner - Vec2::from(*wanted)).norm() < 1e-7, "{corners:?}");
    }
}

/// Edge X to Y joined with edge A to B: B comes to X, and A onto the way to Y.
const NODES: &str = "<det><node type='NodePoint' idObject='101'/><node type='NodePoint' idObject='102'/>\
    <node type='NodePoint' idObject='103'/></det>\
    <det><node type='NodePoint' idObject='201'/><node type='NodePoint' idObject='202'/>\
    <node type='NodePoint' idObject='203'/></det>";

/// Places of A and C once they are joined (cm).
fn moved() -> [[f64; 2]; 2] {
    let half = 0.5_f64.sqrt();
    let a = [10.0 - 4.0 * half, 4.0 * half];
    [a, [a[0] + 3.0 * half, a[1] + 3.0 * half]]
}

#[test]
fn nodes_of_both_pieces_have_images() {
    let children: String = (400..405)
        .map(|id| format!("<child>{id}</child>"))
        .collect();
    let tool = format!(
        "<tools type='unionDetails' id='310' indexD1='1' indexD2='0'>{NODES}<children>{children}</children></tools>"
    );
    let nodes = [400, 401, 402, 403, 404].map(|id| ("Point", id));
    let reading = joined("", &tool, &nodes);
    let [a, c] = moved();
    assert_corners(
        &reading,
        &[[0.0, 0.0], [10.0, 0.0], c, a, [0.0, 10.0]],
        56.0,
    );
}

#[test]
fn older_files_keep_the_nodes_of_the_first_piece() {
    let tool = format!(
        "<tools type='unionDetails' id='310' indexD1='1' indexD2='0'>{NODES}<children><child>400</child></children></tools>"
    );
    let nodes = [101, 102, 400, 103].map(|id| ("Point", id));
    let reading = joined("", &tool, &nodes);
    let [_, c] = moved();
    let swept = [[0.0, 0.0], [10.0, 0.0], c, [0.0, 10.0]];
    let cross = |k: usize| {
        let (a, b) = (swept[k], swept[(k + 1) % 4]);
        a[0] * b[1] - a[1] * b[0]
    };
    assert_corners(&reading, &swept, (0..4).map(cross).sum::<f64>() / 2.0);
}

#[test]
fn curves_of_another_drawing_are_moved_too() {
    // An arc of 90 degrees round A through points at 5 cm: D and E are its ends, and the second piece is A, D, E.
    let arc = "<point type='endLine' id='15' name='D' basePoint='11' angle='0' length='5'/>\
        <point type='endLine' id='16' name='E' basePoint='11' angle='90' length='5'/>\
        <arc type='simple' id='14' center='11' radius='5' angle1='0' angle2='90'/>";
    let quarter = "<det><node type='NodePoint' idObject='201'/><node type='NodePoint' idObject='15'/>\
        <node type='NodeArc' idObject='204'/><node type='NodePoint' idObject='16'/></det>";
    let det = NODES.split_inclusive("</det>").next().unwrap();
    let children: String = (400..406)
        .map(|id| format!("<child>{id}</child>"))
        .collect();
    let tool = format!(
        "<tools type='unionDetails' id='310' indexD1='1' indexD2='0'>{det}{quarter}\
         <children><nodes>{children}</nodes></children></tools>"
    );
    let kinds = ["Point", "Point", "Arc", "Point", "Point", "Point"];
    let nodes: Vec<_> = kinds.into_iter().zip(400..406).collect();
    let reading = joined(arc, &tool, &nodes);
    assert_eq!(reading.losses, []);
    let area = outline(&reading).1;
    let wanted = 50.0 + 25.0 * std::f64::consts::FRAC_PI_4;
    assert!((area - wanted).abs() < 1e-2, "{area}, not {wanted}");
}

#[test]
fn images_that_fit_no_order_of_the_nodes_are_named() {
    let tool = format!(
        "<tools type='unionDetails' id='310' indexD1='1' indexD2='7'>{NODES}<children><child>400</child></children></tools>"
    );
    let nodes = [101, 102, 103].map(|id| ("Point", id));
    let reading = joined("", &tool, &nodes);
    assert_eq!(reading.losses.len(), 1, "{:?}", reading.losses);
    assert!(
        reading.losses[0].why.contains("no edge 7"),
        "{:?}",
        reading.losses
    );
}
