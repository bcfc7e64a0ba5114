//! Outlines of pieces: curves cut to their neighbours, loops, nodes under other numbers.

use super::{AXES, evaluated, file, read};
use crate::valentina::ValentinaReading;
use toile_geometry::Curve;

/// An arc of 10 cm from X to Y as 5, its middle M as 6.
const ARC: &str = "<arc type='simple' id='5' center='1' radius='10' angle1='0' angle2='90'/>\
    <point type='cutArc' id='6' name='M' arc='5' length='Arc_O_5/2'/>";

/// A piece with nodes, each a kind, an object and further attributes.
fn piece(tools: &str, nodes: &[(&str, u32, &str)]) -> ValentinaReading {
    let (mut modeling, mut list) = (String::new(), String::new());
    for (k, (kind, object, more)) in nodes.iter().enumerate() {
        let (id, tag) = (500 + k, if *kind == "Point" { "point" } else { "arc" });
        modeling += &format!("<{tag} id='{id}' idObject='{object}' type='modeling'/>");
        list += &format!("<node type='Node{kind}' idObject='{id}' {more}/>");
    }
    let text = format!(
        "<modeling>{modeling}</modeling><details><detail id='900' name='d' version='2'>\
         <nodes>{list}</nodes></detail></details>"
    );
    read(&file("", &format!("{AXES}{tools}"), &text))
}

/// Area of the first panel (cm2).
fn area(reading: &ValentinaReading) -> f64 {
    let evaluation = evaluated(reading);
    assert_eq!(evaluation.diagnostics(), []);
    let outline = reading.pattern.panels[0].outline().unwrap();
    let paths = outline
        .edges
        .iter()
        .map(|edge| evaluation.edge(edge.id).unwrap());
    let swept: f64 = paths
        .flat_map(|path| path.curves())
        .map(Curve::swept_area)
        .sum();
    swept / 2.0 * 1e4
}

fn check(what: &str, reading: &ValentinaReading, wanted: f64, losses: usize) {
    let found = area(reading);
    assert!(
        (found - wanted).abs() < 1e-6,
        "{what}: {found}, not {wanted}"
    );
    assert_eq!(reading.losses.len(), losses, "{what}: {:?}", reading.losses);
}

#[test]
fn a_curve_is_cut_to_neighbours_on_it_and_left_out_where_it_runs_back() {
    let quarter = std::f64::consts::PI * 25.0;
    let (o, x, y, m) = (
        ("Point", 1, ""),
        ("Point", 2, ""),
        ("Point", 3, ""),
        ("Point", 6, ""),
    );
    let (on, back) = (("Arc", 5, ""), ("Arc", 5, "reverse='1'"));
    for (what, nodes, wanted, losses) in [
        ("whole", [o, x, on, y], quarter, 0),
        ("reversed", [o, y, back, x], quarter, 0),
        ("first half", [o, x, on, m], quarter / 2.0, 0),
        ("second half", [o, m, on, y], quarter / 2.0, 0),
        ("half, reversed", [o, m, back, x], quarter / 2.0, 0),
        ("against the outline", [o, x, back, y], 50.0, 1),
        ("half, against it", [o, m, on, x], 25.0, 1),
    ] {
        check(what, &piece(ARC, &nodes), wanted, losses);
    }
    // Nodes that are excluded do not cut.
    let excluded = ("Point", 6, "excluded='1'");
    check(
        "excluded",
        &piece(ARC, &[o, x, on, excluded, y]),
        quarter,
        0,
    );
    check(
        "excluded before",
        &piece(ARC, &[o, x, excluded, on, y]),
        quarter,
        0,
    );
}

#[test]
fn a_curve_is_cut_by_the_end_of_a_neighbouring_curve() {
    // From M straight in to O as an arc of no great bulge: the sector from X to M, less the bulge.
    let tools = format!(
        "{ARC}<spline type='simpleInteractive' id='7' point1='6' point4='1' angle1='225' angle2='45' length1='3' length2='3'/>"
    );
    let reading = piece(&tools, &[("Point", 2, ""), ("Arc", 5, ""), ("Arc", 7, "")]);
    check(
        "curve beside curve",
        &reading,
        std::f64::consts::PI * 12.5,
        0,
    );
}

#[test]
fn loops_of_an_outline_are_left_out_from_its_first_node_on() {
    let corner = |id: u32, x: f64, y: f64| {
        format!(
            "<point type='single' id='{id}' name='N{id}' x='{x}' y='{}'/>",
            -y
        )
    };
    let nodes = |ids: &[u32]| -> Vec<(&'static str, u32, &'static str)> {
        ids.iter().map(|&id| ("Point", id, "")).collect()
    };
    // A dart whose mouth is closed beyond itself: it is left out.
    let dart: String = [
        corner(20, 10.0, 5.0),
        corner(21, 5.0, 5.0),
        corner(22, 5.0, 2.0),
        corner(23, 5.4, 5.3),
        corner(24, 0.0, 5.0),
    ]
    .concat();
    let reading = piece(&dart, &nodes(&[1, 2, 20, 21, 22, 23, 24]));
    assert_eq!(reading.losses.len(), 1, "{:?}", reading.losses);
    assert!(reading.losses[0].what.contains("loop"));
    // Left over the rectangle is a triangle: (0, 5), up to (5.4, 5.3), and down the leg to y = 5, at x = 5 + 0.4 / 1.1.
    let found = area(&reading);
    let expected = 50.0 + 0.15 * (5.0 + 0.4 / 1.1);
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    // A loop at the beginning keeps the first node: the square below, not the one above.
    let two: String = [
        corner(20, 10.0, 5.0),
        corner(21, 3.0, 5.0),
        corner(22, 3.0, -2.0),
        corner(23, 0.0, -2.0),
    ]
    .concat();
    let reading = piece(&two, &nodes(&[1, 2, 20, 21, 22, 23]));
    check("two squares", &reading, 6.0, 1);
}

#[test]
fn an_outline_that_returns_to_a_corner_or_touches_itself_goes_on_from_there() {
    let corner = |id: u32, x: f64, y: f64| {
        format!(
            "<point type='single' id='{id}' name='N{id}' x='{x}' y='{}'/>",
            -y
        )
    };
    let tools: String = [
        corner(20, 10.0, 6.0),
        corner(21, 5.0, 6.0),
        corner(22, 3.0, 3.0),
        corner(23, 7.0, 3.0),
        corner(24, 0.0, 6.0),
        corner(25, -3.0, -3.0),
        corner(26, 3.0, -3.0),
        corner(27, 4.0, 6.0),
        corner(28, 4.0, 0.0),
        corner(29, 2.0, 3.0),
    ]
    .concat();
    for (what, ids, wanted) in [
        ("a dart", [1, 2, 20, 21, 22, 23, 21, 24], 60.0),
        ("two darts", [1, 2, 21, 22, 21, 23, 21, 24], 45.0),
        ("the start", [1, 25, 26, 1, 2, 20, 21, 24], 60.0),
        // What lies before the last return is left out, also where it is the larger part.
        ("the end", [1, 2, 20, 21, 24, 1, 25, 26], 9.0),
        ("a touched line", [1, 2, 20, 27, 28, 29, 24, 24], 12.0),
    ] {
        let nodes = ids.map(|id| ("Point", id, ""));
        check(what, &piece(&tools, &nodes), wanted, 1);
    }
}

#[test]
fn a_tip_in_which_the_ends_of_an_outline_cross_is_left_out() {
    // A line that meets the arc 2 degrees after the start of that, and ends at that start.
    let (sin, cos) = 1_f64.to_radians().sin_cos();
    let far = 10.0 - 10.0 * sin / cos;
    let corner = format!("<point type='single' id='20' name='N' x='{far}' y='-10'/>");
    let nodes = [("Arc", 5, ""), ("Point", 3, ""), ("Point", 20, "")];
    let reading = piece(&format!("{ARC}{corner}"), &nodes);
    let (sin, cos) = 2_f64.to_radians().sin_cos();
    let sector = 88_f64.to_radians() * 50.0;
    let twice = -10.0 * far + far * 10.0 * sin - 10.0 * 10.0 * cos;
    check("tip", &reading, -(sector + twice / 2.0), 1);
}

#[test]
fn a_slit_of_an_outline_is_left_out() {
    let corner = |id: u32, x: f64, y: f64| {
        format!(
            "<point type='single' id='{id}' name='N{id}' x='{x}' y='{}'/>",
            -y
        )
    };
    let tools: String = [
        corner(20, 10.0, 5.0),
        corner(21, 5.0, 5.0),
        corner(22, 5.0, 2.0),
        corner(23, 0.0, 5.0),
    ]
    .concat();
    let nodes = [1, 2, 20, 21, 22, 21, 23].map(|id| ("Point", id, ""));
    let reading = piece(&tools, &nodes);
    check("slit", &reading, 50.0, 1);
    let outline = reading.pattern.panels[0].outline().unwrap();
    assert_eq!(outline.edges.len(), 5);
}

#[test]
fn nodes_may_be_known_under_the_number_of_another_drawing_or_node() {
    let text = file(
        "",
        AXES,
        "<modeling><point id='101' idObject='1'/><point id='102' idObject='2'/></modeling>",
    );
    let second = "<draw name='second'><calculation/><modeling><point id='201' idObject='101'/>\
        <point id='203' idObject='3'/></modeling><details><detail id='300' name='d' version='2'><nodes>\
        <node type='NodePoint' idObject='201'/><node type='NodePoint' idObject='102'/>\
        <node type='NodePoint' idObject='203'/></nodes></detail></details></draw></pattern>";
    let reading = read(&text.replace("</pattern>", second));
    check("another drawing", &reading, 50.0, 0);
}

#[test]
fn lists_of_a_piece_without_counterpart_are_named() {
    let text = "<modeling/><details><detail id='900' name='d' version='2'><nodes>\
        <node type='NodePoint' idObject='1'/><node type='NodePoint' idObject='2'/>\
        <node type='NodePoint' idObject='3'/></nodes><placeLabels><record>7</record><record>8</record></placeLabels>\
        <pins><record>9</record></pins></detail></details><groups><group id='1' name='g'/></groups>";
    let reading = read(&file("", AXES, text));
    let told: Vec<(&str, usize)> = reading
        .losses
        .iter()
        .map(|loss| (loss.what.as_str(), loss.count))
        .collect();
    assert_eq!(
        told,
        [("place labels", 2), ("pins", 1), ("groups of objects", 1)]
    );
}
