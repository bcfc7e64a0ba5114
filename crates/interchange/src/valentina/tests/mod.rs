//! Tools and formulas of small files, each against places worked out by hand.

mod damaged;
mod formulas;
mod joined_pieces;
mod outlines;
mod pieces;
mod referee;
mod sizes;
mod variants;

use super::{ValentinaReading, read_valentina};
use toile_geometry::Vec2;
use toile_pattern::{Evaluation, Number, PointRule};

/// A file in centimetres with a drawing.
fn file(before: &str, tools: &str, pieces: &str) -> String {
    format!(
        "<?xml version='1.0'?><pattern><version>0.4.0</version><unit>cm</unit>{before}\
         <draw name='front'><calculation>{tools}</calculation>{pieces}</draw></pattern>"
    )
}

/// The axes of most tests: O at the origin, X 10 cm to the right, Y 10 cm above.
const AXES: &str = "<point type='single' id='1' name='O' x='0' y='0'/>\
    <point type='endLine' id='2' name='X' basePoint='1' angle='0' length='10'/>\
    <point type='endLine' id='3' name='Y' basePoint='1' angle='90' length='10'/>";

fn read(text: &str) -> ValentinaReading {
    read_valentina(text, &[]).unwrap()
}

fn evaluated(reading: &ValentinaReading) -> Evaluation {
    let wearer = reading.pattern.base_measurements().cloned();
    Evaluation::new(&reading.pattern, &wearer.unwrap_or_default())
}

/// Place of a point of the first sheet (cm).
fn place(reading: &ValentinaReading, name: &str) -> Vec2 {
    let point = reading.pattern.sheets[0].point_named(name).unwrap();
    evaluated(reading).point(point.id).unwrap() * 100.0
}

fn assert_near(found: Vec2, [x, y]: [f64; 2], what: &str) {
    let off = (found - Vec2::new(x, y)).norm();
    // 1e-9 m are 1e-7 cm.
    assert!(off < 1e-7, "{what}: {found:?}, not {x}, {y}");
}

/// One tool after the axes, and the place of its point P by hand.
fn check_tool(tools: &str, at: [f64; 2]) {
    let reading = read(&file("", &format!("{AXES}{tools}"), ""));
    assert_eq!(reading.losses, [], "{tools}");
    assert_near(place(&reading, "P"), at, tools);
    let point = reading.pattern.sheets[0].point_named("P").unwrap();
    let is_kept = matches!(
        &point.rule,
        PointRule::At {
            x: Number::Value(_),
            ..
        }
    );
    assert_eq!(is_kept, tools.contains("single"), "{tools}");
}

#[test]
fn each_plain_tool_has_the_place_worked_out_by_hand() {
    let half = 0.5_f64.sqrt();
    for (tools, at) in [
        (
            "<point type='single' id='9' name='P' x='1' y='2'/>",
            [1.0, -2.0],
        ),
        (
            "<point type='endLine' id='9' name='P' basePoint='2' angle='45' length='2'/>",
            [10.0 + 2.0 * half, 2.0 * half],
        ),
        (
            "<point type='endLine' id='9' name='P' basePoint='2' angle='AngleLine_O_Y*2' length='Line_O_X/4'/>",
            [7.5, 0.0],
        ),
        (
            "<point type='alongLine' id='9' name='P' firstPoint='2' secondPoint='3' length='CurrentLength/4'/>",
            [7.5, 2.5],
        ),
        (
            "<point type='alongLine' id='9' name='P' firstPoint='1' secondPoint='2' length='-3'/>",
            [-3.0, 0.0],
        ),
        (
            "<point type='normal' id='9' name='P' firstPoint='2' secondPoint='1' angle='0' length='4'/>",
            [10.0, -4.0],
        ),
        (
            "<point type='normal' id='9' name='P' firstPoint='1' secondPoint='2' angle='45' length='2'/>",
            [-2.0 * half, 2.0 * half],
        ),
        (
            "<point type='pointOfIntersection' id='9' name='P' firstPoint='2' secondPoint='3'/>",
            [10.0, 10.0],
        ),
        (
            "<point type='intersectXY' id='9' name='P' firstPoint='3' secondPoint='2'/>",
            [0.0, 0.0],
        ),
        (
            "<point type='height' id='9' name='P' basePoint='1' p1Line='2' p2Line='3'/>",
            [5.0, 5.0],
        ),
        (
            "<point type='bisector' id='9' name='P' firstPoint='2' secondPoint='1' thirdPoint='3' length='2'/>",
            [2.0 * half, 2.0 * half],
        ),
        (
            "<point type='bisector' id='9' name='P' firstPoint='3' secondPoint='1' thirdPoint='2' length='2'/>",
            [2.0 * half, 2.0 * half],
        ),
        (
            "<point type='lineIntersectAxis' id='9' name='P' basePoint='1' angle='45' p1Line='2' p2Line='3'/>",
            [5.0, 5.0],
        ),
        (
            "<point type='single' id='7' name='Q' x='5' y='-20'/>\
          <point type='single' id='8' name='R' x='5' y='20'/><point type='lineIntersect' id='9' name='PP' p1Line1='7' p2Line1='8' p1Line2='2' p2Line2='3'/>\
          <point type='alongLine' id='10' name='P' firstPoint='9' secondPoint='8' length='0'/>",
            [5.0, 5.0],
        ),
    ] {
        if tools.contains("'R'") {
            let reading = read(&file("", &format!("{AXES}{tools}"), ""));
            assert_near(place(&reading, "P"), at, tools);
            continue;
        }
        check_tool(tools, at);
    }
}

#[test]
fn strokes_of_the_compass_have_the_places_worked_out_by_hand() {
    for (tools, at) in [
        // A right triangle of 3, 4 and 5.
        (
            "<point type='pointOfContact' id='9' name='P' firstPoint='1' secondPoint='2' center='4' radius='41^0.5'/>",
            [8.0, 0.0],
        ),
        (
            "<point type='pointOfContact' id='9' name='P' firstPoint='1' secondPoint='2' center='4' radius='4.1'/>",
            [3.0 - 0.81_f64.sqrt(), 0.0],
        ),
        (
            "<point type='shoulder' id='9' name='P' p1Line='1' p2Line='2' pShoulder='4' length='Line_O_X+80^0.5'/>",
            [3.0 + ((10.0 + 80.0_f64.sqrt()).powi(2) - 16.0).sqrt(), 0.0],
        ),
        (
            "<point type='triangle' id='9' name='P' axisP1='6' axisP2='4' firstPoint='1' secondPoint='2'/>",
            [3.0, 21.0_f64.sqrt()],
        ),
        (
            "<point type='pointOfIntersectionCircles' id='9' name='P' c1Center='1' c2Center='2' c1Radius='6' c2Radius='8' crossPoint='2'/>",
            [3.6, 4.8],
        ),
        (
            "<point type='pointFromCircleAndTangent' id='9' name='P' cCenter='2' cRadius='8' tangent='1' crossPoint='2'/>",
            [3.6, 4.8],
        ),
        (
            "<arc type='simple' id='8' center='2' radius='8' angle1='100' angle2='200'/>\
          <point type='pointFromArcAndTangent' id='9' name='P' arc='8' tangent='1' crossPoint='2'/>",
            [3.6, 4.8],
        ),
        (
            "<point type='pointOfIntersectionCircles' id='9' name='P' c1Center='1' c2Center='2' c1Radius='6' c2Radius='8' crossPoint='1'/>",
            [3.6, -4.8],
        ),
    ] {
        let further = "<point type='endLine' id='6' name='M' basePoint='1' angle='0' length='3'/>\
            <point type='endLine' id='4' name='C' basePoint='6' angle='90' length='4'/>\
            <point type='endLine' id='7' name='N' basePoint='1' angle='90' length='4'/>\
            <point type='endLine' id='5' name='L' basePoint='7' angle='0' length='1'/>";
        check_tool(&format!("{further}{tools}"), at);
    }
}

#[test]
fn true_darts_meet_when_they_are_closed() {
    // A dart of 2 cm at the middle of a line along x, its tip 10 cm below; the line drops behind the dart.
    let tools = "<point type='single' id='4' name='A' x='-10' y='0'/>\
        <point type='single' id='5' name='B' x='10' y='2'/><point type='single' id='6' name='D1' x='-1' y='0'/>\
        <point type='single' id='7' name='D2' x='0' y='10'/><point type='single' id='8' name='D3' x='1' y='0'/>\
        <point type='trueDarts' id='9' name1='E' name2='F' point1='10' point2='11' baseLineP1='4' baseLineP2='5' \
        dartP1='6' dartP2='7' dartP3='8'/>";
    let reading = read(&file("", tools, ""));
    assert_eq!(reading.losses, []);
    let (e, f) = (place(&reading, "E"), place(&reading, "F"));
    let tip = Vec2::new(0.0, -10.0);
    // Both legs have one length, and each point is on its leg.
    assert!(((e - tip).norm() - (f - tip).norm()).abs() < 1e-7);
    assert!((e - tip).perp(&Vec2::new(-1.0, 10.0)).abs() < 1e-7);
    assert!((f - tip).perp(&Vec2::new(1.0, 10.0)).abs() < 1e-7);
    // Closed, the line runs straight from A through E to B.
    let turn = 2.0 * 0.1_f64.atan();
    let (sin, cos) = turn.sin_cos();
    let way = Vec2::new(10.0, -2.0) - tip;
    let closed = tip + Vec2::new(way.x * cos - way.y * sin, way.x * sin + way.y * cos);
    let a = Vec2::new(-10.0, 0.0);
    assert!((e - a).perp(&(closed - a)).abs() < 1e-6, "{e:?}");
}

#[test]
fn an_elliptic_arc_keeps_its_shape_in_the_base_size_which_is_said() {
    let tools = "<elArc type='simple' id='5' center='1' radius1='6' radius2='3' angle1='0' angle2='180' rotationAngle='90'/>\
        <point type='curveIntersectAxis' id='9' name='P' curve='5' basePoint='1' angle='180'/>";
    let reading = read(&file("", &format!("{AXES}{tools}"), ""));
    assert_eq!(reading.losses.len(), 1);
    assert_near(
        place(&reading, "P"),
        [-3.0, 0.0],
        "the end of the short axis",
    );
}

/// An arc of 5 cm round O from X's direction to Y's, as number 5.
const ARC: &str = "<arc type='simple' id='5' center='1' radius='5' angle1='0' angle2='90'/>";

#[test]
fn points_on_arcs_have_the_places_worked_out_by_hand() {
    let half = 0.5_f64.sqrt();
    let quarter = std::f64::consts::PI * 2.5;
    for (tools, at) in [
        ("<point type='cutArc' id='9' name='P' arc='5' length='Arc_O_5/2'/>".to_owned(), [5.0 * half, 5.0 * half]),
        (format!("<point type='cutArc' id='9' name='P' arc='5' length='-{quarter}/2'/>"), [5.0 * half, 5.0 * half]),
        ("<point type='curveIntersectAxis' id='9' name='P' curve='5' basePoint='1' angle='225'/>".to_owned(), [5.0 * half, 5.0 * half]),
        ("<point type='endLine' id='9' name='P' basePoint='1' angle='Angle2Arc_O_5' length='RadiusArc_O_5*2'/>".to_owned(), [0.0, 10.0]),
        (format!("<arc type='arcWithLength' id='6' center='2' radius='5' angle1='90' length='{quarter}'/>\
          <point type='cutArc' id='9' name='P' arc='6' length='Arc_X_6/2'/>"), [10.0 - 5.0 * half, 5.0 * half]),
        ("<arc type='simple' id='6' center='2' radius='Line_O_X/2' angle1='AngleLine_O_Y' angle2='AngleLine_O_Y-270'/>\
          <point type='cutArc' id='9' name='P' arc='6' length='Arc_X_6/2'/>".to_owned(), [10.0 - 5.0 * half, 5.0 * half]),
        ("<arc type='simple' id='6' center='2' radius='8' angle1='90' angle2='270'/>\
          <point type='pointOfIntersectionArcs' id='9' name='P' firstArc='5' secondArc='6' crossPoint='1'/>".to_owned(), [3.05, (25.0_f64 - 3.05 * 3.05).sqrt()]),
        ("<arc type='simple' id='6' center='2' radius='8' angle1='90' angle2='270'/>\
          <point type='pointOfIntersectionCurves' id='9' name='P' curve1='5' curve2='6' vCrossPoint='1' hCrossPoint='1'/>".to_owned(), [3.05, (25.0_f64 - 3.05 * 3.05).sqrt()]),
    ] {
        check_tool(&format!("{ARC}{tools}"), at);
    }
}

#[test]
fn splines_have_the_middle_of_their_handles() {
    let handle = 4.0 / 3.0 * (std::f64::consts::PI / 8.0).tan() / 2.0_f64.sqrt() * 10.0;
    // A symmetric cubic is cut in its middle: at three quarters of the handles' height.
    for (spline, height) in [
        (
            "<spline type='simple' id='5' point1='1' point4='2' angle1='90' angle2='90' kAsm1='1' kAsm2='1' kCurve='2'/>",
            0.75 * 2.0 * handle,
        ),
        (
            "<spline type='simpleInteractive' id='5' point1='1' point4='2' angle1='90' angle2='90' length1='Line_O_X/2' length2='5'/>",
            3.75,
        ),
        (
            "<point type='single' id='7' name='A' x='0' y='-4'/><point type='single' id='8' name='B' x='10' y='-4'/>\
          <spline type='cubicBezier' id='5' point1='1' point2='7' point3='8' point4='2'/>",
            3.0,
        ),
    ] {
        let cut = "<point type='cutSpline' id='9' name='P' spline='5' length='Spl_O_X/2'/>";
        let reading = read(&file("", &format!("{AXES}{spline}{cut}"), ""));
        assert_eq!(reading.losses, [], "{spline}");
        assert_near(place(&reading, "P"), [5.0, height], spline);
    }
}

#[test]
fn paths_go_through_their_points_with_the_handles_of_both_sides() {
    // Two halves of a wave, each with its middle by hand.
    let interactive = "<spline type='pathInteractive' id='5'>\
        <pathPoint pSpline='1' angle1='270' length1='0' angle2='90' length2='4'/>\
        <pathPoint pSpline='2' angle1='90' length1='4' angle2='270' length2='4'/>\
        <pathPoint pSpline='4' angle1='270' length1='4' angle2='90' length2='0'/></spline>";
    let share = 4.0 / 3.0 * (std::f64::consts::PI / 8.0).tan() / 2.0_f64.sqrt() * 10.0;
    let old = "<spline type='path' id='5' kCurve='1'>\
        <pathPoint pSpline='1' angle='90' kAsm1='1' kAsm2='1'/>\
        <pathPoint pSpline='2' angle='270' kAsm1='1' kAsm2='1'/>\
        <pathPoint pSpline='4' angle='90' kAsm1='1' kAsm2='1'/></spline>";
    let further = "<point type='endLine' id='4' name='Z' basePoint='2' angle='0' length='10'/>";
    for (spline, height) in [(interactive, 3.0), (old, 0.75 * share)] {
        let cuts = "<point type='cutSplinePath' id='9' name='P' splinePath='5' length='SplPath_O_Z/4'/>\
            <point type='cutSplinePath' id='12' name='Q' splinePath='5' length='SplPath_O_Z-SplPath_O_P'/>";
        let reading = read(&file("", &format!("{AXES}{further}{spline}{cuts}"), ""));
        assert_eq!(reading.losses, [], "{spline}");
        assert_near(place(&reading, "P"), [5.0, height], spline);
        assert_near(place(&reading, "Q"), [15.0, -height], spline);
    }
}

#[test]
fn operations_carry_points_and_curves() {
    let lists = "<source><item idObject='2'/><item idObject='5'/></source>\
        <destination><item idObject='21'/><item idObject='22'/></destination></operation>";
    let cut = "<point type='cutArc' id='30' name='P' arc='22' length='Arc_O_5/2'/>";
    let half = 0.5_f64.sqrt();
    for (start, at, middle) in [
        (
            "<operation type='rotation' id='20' center='1' angle='90' suffix='a1'>",
            [0.0, 10.0],
            [-5.0 * half, 5.0 * half],
        ),
        (
            "<operation type='moving' id='20' angle='90' length='3' suffix='a1'>",
            [10.0, 3.0],
            [5.0 * half, 5.0 * half + 3.0],
        ),
        (
            "<operation type='flippingByLine' id='20' p1Line='1' p2Line='3' suffix='a1'>",
            [-10.0, 0.0],
            [-5.0 * half, 5.0 * half],
        ),
        (
            "<operation type='flippingByAxis' id='20' center='2' axisType='1' suffix='a1'>",
            [10.0, 0.0],
            [20.0 - 5.0 * half, 5.0 * half],
        ),
        (
            "<operation type='flippingByAxis' id='20' center='3' axisType='2' suffix='a1'>",
            [10.0, 20.0],
            [5.0 * half, 20.0 - 5.0 * half],
        ),
    ] {
        let reading = read(&file("", &format!("{AXES}{ARC}{start}{lists}{cut}"), ""));
        assert_eq!(reading.losses, [], "{start}");
        assert_near(place(&reading, "Xa1"), at, start);
        assert_near(place(&reading, "P"), middle, start);
    }
}
