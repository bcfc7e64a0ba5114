//! Variants of tools: values out of reach, older and newer attributes, each against a place by hand.

use super::{ARC, AXES, assert_near, check_tool, evaluated, file, place, read};

/// A file of a version, with tools after the axes.
fn of_version(version: &str, tools: &str) -> String {
    let text = file("", &format!("{AXES}{tools}"), "");
    text.replace("0.4.0", version)
}

/// A tool that cannot do what it says in the base size: its point P has a place all the same, and it is said.
fn check_told(tools: &str, at: [f64; 2]) {
    let reading = read(&file("", &format!("{AXES}{tools}"), ""));
    assert_near(place(&reading, "P"), at, tools);
    let told = reading.losses.iter().filter(|loss| loss.place == "P");
    assert_eq!(told.count(), 1, "{tools}: {:?}", reading.losses);
}

/// A point M at a place (cm).
fn m(x: f64, y: f64) -> String {
    format!(
        "<point type='endLine' id='120' name='Mx' basePoint='1' angle='0' length='{x}'/>\
         <point type='endLine' id='20' name='M' basePoint='120' angle='90' length='{y}'/>"
    )
}

#[test]
fn a_shoulder_reaches_beyond_the_end_of_its_line_or_stays_there() {
    let tool =
        "<point type='shoulder' id='9' name='P' p1Line='1' p2Line='2' pShoulder='20' length='3'/>";
    check_tool(&format!("{}{tool}", m(15.0, 0.0)), [18.0, 0.0]);
    check_tool(&format!("{}{tool}", m(8.0, 1.8)), [10.4, 0.0]);
    check_told(&format!("{}{tool}", m(5.0, 0.0)), [10.0, 0.0]);
    let back = tool.replace("p1Line='1' p2Line='2'", "p1Line='2' p2Line='1'");
    check_told(&format!("{}{back}", m(5.0, 0.0)), [0.0, 0.0]);
}

#[test]
fn a_triangle_has_its_corner_on_an_axis_that_passes_between_its_points() {
    let ends = |a: [f64; 2], b: [f64; 2]| {
        let second = m(b[0], b[1])
            .replace("'120'", "'121'")
            .replace("'20'", "'21'");
        let second = second.replace("'Mx'", "'Nx'").replace("'M'", "'N'");
        format!("{}{second}", m(a[0], a[1]))
    };
    let tool = "<point type='triangle' id='9' name='P' axisP1='1' axisP2='2' firstPoint='20' secondPoint='21'/>";
    let across = ends([3.0, 4.0], [7.0, -2.0]);
    check_tool(&format!("{across}{tool}"), [5.0 + 12.0_f64.sqrt(), 0.0]);
    let back = tool.replace("axisP1='1' axisP2='2'", "axisP1='2' axisP2='1'");
    check_tool(&format!("{across}{back}"), [5.0 - 12.0_f64.sqrt(), 0.0]);
    // Both points on one side: where their line meets the axis.
    let aside = ends([3.0, 2.0], [9.0, 1.0]);
    check_told(&format!("{aside}{tool}"), [15.0, 0.0]);
}

#[test]
fn circles_that_touch_a_line_or_each_other_but_for_rounding_have_their_point() {
    let contact = "<point type='pointOfContact' id='9' name='P' firstPoint='2' secondPoint='3' center='1' \
        radius='50^0.5*0.99999999999999'/>";
    check_tool(contact, [5.0, 5.0]);
    let circles = "<point type='pointOfIntersectionCircles' id='9' name='P' c1Center='1' c2Center='2' c1Radius='6' \
        c2Radius='4*0.99999999999999' crossPoint='1'/>";
    check_tool(circles, [6.0, 0.0]);
}

#[test]
fn a_length_of_two_names_is_that_of_the_latest_line_between_such_points() {
    // Where no tool joins two points, the latest drawing with both names counts: Y to O, 11 cm there.
    let second = "<draw name='second'><calculation><point type='single' id='21' name='O' x='3' y='0'/>\
        <point type='endLine' id='22' name='P' basePoint='21' angle='0' length='Line_O_X'/>\
        <point type='endLine' id='23' name='X' basePoint='21' angle='90' length='4'/>\
        <point type='endLine' id='24' name='Q' basePoint='21' angle='0' length='Line_O_X'/>\
        <point type='endLine' id='25' name='Y' basePoint='22' angle='0' length='1'/>\
        <point type='endLine' id='26' name='R' basePoint='21' angle='0' length='Line_O_Y+Line_Y_O'/>\
        </calculation></draw></pattern>";
    let reading = read(&file("", AXES, "").replace("</pattern>", second));
    let sheet = &reading.pattern.sheets[1];
    let evaluation = evaluated(&reading);
    for (name, at) in [("P", [13.0, 0.0]), ("Q", [7.0, 0.0]), ("R", [24.0, 0.0])] {
        let point = sheet.point_named(name).unwrap();
        assert_near(evaluation.point(point.id).unwrap() * 100.0, at, name);
    }
}

#[test]
fn an_image_of_an_image_is_known_by_both_suffixes_after_the_name_of_the_curve() {
    let moved = |id: u32, suffix: &str, from: u32| {
        format!(
            "<operation type='moving' id='{id}' angle='90' length='3' suffix='{suffix}'><source><item idObject='{from}'/>\
             </source><destination><item idObject='{}'/></destination></operation>",
            id + 1
        )
    };
    let tools = format!(
        "<spline type='simpleInteractive' id='20' point1='1' point4='2' angle1='0' angle2='180' length1='3' length2='3'/>\
         {}{}<point type='endLine' id='9' name='P' basePoint='1' angle='0' length='Spl_O_Xa1b1/2'/>",
        moved(30, "a1", 20),
        moved(40, "b1", 31)
    );
    check_tool(&tools, [5.0, 0.0]);
}

#[test]
fn contacts_take_the_place_on_the_line_nearer_to_its_start() {
    let tool = |first: u32, second: u32, radius: f64| {
        format!(
            "<point type='pointOfContact' id='9' name='P' firstPoint='{first}' secondPoint='{second}' center='20' radius='{radius}'/>"
        )
    };
    for (at, first, radius, x) in [
        (5.0, 1, 3.0, 2.0),
        (5.0, 2, 3.0, 8.0),
        (15.0, 1, 3.0, 12.0),
        (-15.0, 1, 3.0, -12.0),
        (8.0, 1, 3.0, 5.0),
        (2.0, 1, 3.0, 5.0),
        (4.0, 1, 20.0, -16.0),
    ] {
        let tool = tool(first, 3 - first, radius);
        check_tool(&format!("{}{tool}", m(at, 0.0)), [x, 0.0]);
    }
    check_told(&format!("{}{}", m(3.0, 30.0), tool(2, 1, 3.0)), [0.0, 0.0]);
}

#[test]
fn tools_without_a_place_lie_at_the_origin_which_is_said() {
    for tools in [
        "<point type='single' id='20' name='A' x='1' y='-3'/><point type='single' id='21' name='B' x='6' y='-3'/>\
         <point type='lineIntersect' id='9' name='P' p1Line1='1' p2Line1='2' p1Line2='20' p2Line2='21'/>",
        "<point type='single' id='20' name='A' x='1' y='-3'/>\
         <point type='lineIntersectAxis' id='9' name='P' basePoint='20' angle='0' p1Line='1' p2Line='2'/>",
        "<point type='pointOfIntersectionCircles' id='9' name='P' c1Center='1' c2Center='2' c1Radius='2' c2Radius='3' crossPoint='1'/>",
        "<arc type='simple' id='5' center='1' radius='5' angle1='0' angle2='90'/>\
         <point type='curveIntersectAxis' id='9' name='P' basePoint='3' curve='5' angle='0'/>",
        "<point type='pointFromCircleAndTangent' id='9' name='P' cCenter='1' cRadius='11' tangent='2' crossPoint='1'/>",
    ] {
        check_told(tools, [0.0, 0.0]);
    }
}

#[test]
fn lines_without_length_give_no_direction() {
    let same =
        "<point type='alongLine' id='4' name='S' firstPoint='2' secondPoint='1' length='0'/>";
    for tool in [
        "<point type='alongLine' id='9' name='P' firstPoint='2' secondPoint='4' length='4'/>",
        "<point type='normal' id='9' name='P' firstPoint='2' secondPoint='4' angle='0' length='4'/>",
    ] {
        check_told(&format!("{same}{tool}"), [10.0, 0.0]);
    }
}

#[test]
fn the_bisector_of_a_straight_angle_lies_to_the_left_of_its_first_leg() {
    let left = "<point type='endLine' id='4' name='L' basePoint='1' angle='180' length='7'/>";
    let tool = "<point type='bisector' id='9' name='P' firstPoint='2' secondPoint='1' thirdPoint='4' length='2'/>";
    check_tool(&format!("{left}{tool}"), [0.0, 2.0]);
    let back = tool
        .replace("firstPoint='2'", "firstPoint='4'")
        .replace("thirdPoint='4'", "thirdPoint='2'");
    check_tool(&format!("{left}{back}"), [0.0, -2.0]);
}

#[test]
fn full_circles_and_arcs_against_the_clock_are_cut_where_they_should() {
    let on = |degrees: f64| {
        [
            5.0 * degrees.to_radians().cos(),
            5.0 * degrees.to_radians().sin(),
        ]
    };
    for (arc, third) in [
        ("angle1='90' angle2='0'", 180.0),
        ("angle1='350' angle2='10'", 350.0 + 20.0 / 3.0),
        ("angle1='-90' angle2='90'", -30.0),
        ("angle1='0' angle2='360'", 120.0),
        ("angle1='30' angle2='30'", 150.0),
        ("angle1='720' angle2='90'", 30.0),
    ] {
        let tools = format!(
            "<arc type='simple' id='5' center='1' radius='5' {arc}/>\
             <point type='cutArc' id='9' name='P' arc='5' length='Arc_O_5/3'/>"
        );
        let reading = read(&file("", &format!("{AXES}{tools}"), ""));
        assert_eq!(reading.losses, [], "{tools}");
        // The spline that stands for a full circle is off by some micrometres.
        let off = (place(&reading, "P") - toile_geometry::Vec2::from(on(third))).norm();
        assert!(off < 1e-3, "{arc}: {off}");
    }
    let quarter = std::f64::consts::PI * 2.5;
    for (length, third) in [(quarter, 30.0), (-quarter, -30.0), (40.0, 120.0)] {
        let tools = format!(
            "<arc type='arcWithLength' id='5' center='1' radius='5' angle1='0' length='{length}'/>\
             <point type='cutArc' id='9' name='P' arc='5' length='Arc_O_5/3'/>"
        );
        let reading = read(&file("", &format!("{AXES}{tools}"), ""));
        let off = (place(&reading, "P") - toile_geometry::Vec2::from(on(third))).norm();
        assert!(off < 1e-3, "{length}: {off}");
    }
}

#[test]
fn cuts_beyond_a_curve_stay_a_millimetre_inside_it() {
    for (length, degrees) in [
        ("0", 0.1 / 5.0),
        ("-9", 0.1 / 5.0),
        ("Arc_O_5+3", -0.1 / 5.0),
    ] {
        let from = if degrees < 0.0 {
            std::f64::consts::FRAC_PI_2
        } else {
            0.0
        };
        let angle: f64 = from + degrees;
        let tool = format!("{ARC}<point type='cutArc' id='9' name='P' arc='5' length='{length}'/>");
        check_told(&tool, [5.0 * angle.cos(), 5.0 * angle.sin()]);
    }
}

#[test]
fn negative_lengths_on_splines_count_from_the_end_in_newer_files() {
    let tools = "<spline type='simpleInteractive' id='5' point1='1' point4='2' angle1='0' angle2='180' length1='3' length2='3'/>\
        <point type='cutSpline' id='9' name='P' spline='5' length='-4'/>";
    let reading = read(&of_version("1.0.0", tools));
    assert_eq!(reading.losses, []);
    assert_near(place(&reading, "P"), [6.0, 0.0], "newer");
    let reading = read(&of_version("0.4.0", tools));
    assert_near(place(&reading, "P"), [0.1, 0.0], "older");
    assert_eq!(reading.losses.len(), 1);
}

#[test]
fn curves_are_known_by_their_aliases_handles_and_segments() {
    let path = "<spline type='pathInteractive' id='5' alias='hem'>\
        <pathPoint pSpline='1' angle1='180' length1='0' angle2='0' length2='2'/>\
        <pathPoint pSpline='2' angle1='180' length1='3' angle2='0' length2='1'/>\
        <pathPoint pSpline='4' angle1='180' length1='2' angle2='0' length2='0'/></spline>";
    let further = "<point type='endLine' id='4' name='Z' basePoint='2' angle='0' length='6'/>";
    let cubic = "<point type='single' id='6' name='A' x='0' y='-4'/><point type='single' id='7' name='B' x='10' y='-3'/>\
        <spline type='cubicBezier' id='8' point1='1' point2='6' point3='7' point4='2' alias='top'/>";
    for (formula, value) in [
        ("SplPath_O_Z", 16.0),
        ("SplPath_hem", 16.0),
        ("SplPath_O_Z_Seg_1", 10.0),
        ("SplPath_O_Z_Seg_2", 6.0),
        ("C1LengthSplPath_O_Z", 2.0),
        ("C2LengthSplPath_O_Z_Seg_1", 3.0),
        ("Angle2SplPath_O_Z/10", 18.0),
        ("C1LengthSpl_O_X", 4.0),
        ("Angle2Spl_O_X/10", 9.0),
        ("C2LengthSpl_O_X", 3.0),
    ] {
        let tool = format!(
            "<point type='endLine' id='9' name='P' basePoint='1' angle='0' length='{formula}'/>"
        );
        let tools = format!("{further}{path}{cubic}{tool}");
        let reading = read(&file("", &format!("{AXES}{tools}"), ""));
        assert_eq!(reading.losses, [], "{formula}");
        assert_near(place(&reading, "P"), [value, 0.0], formula);
    }
}

#[test]
fn operations_have_names_of_their_own_for_their_curves() {
    let lists = "<source><item idObject='5'/><item idObject='7' alias='moved'/></source>\
        <destination><item idObject='21'/><item idObject='22'/></destination></operation>";
    let spline = "<spline type='simpleInteractive' id='7' point1='1' point4='2' angle1='0' angle2='180' length1='3' length2='3'/>";
    let quarter = std::f64::consts::PI * 2.5;
    for (formula, value) in [
        ("Arc_O_21", quarter),
        ("Spl_O_Xa1", 10.0),
        ("Spl_moved", 10.0),
    ] {
        let start = "<operation type='rotation' id='20' center='1' angle='90' suffix='a1'>";
        let tool = format!(
            "<point type='endLine' id='9' name='P' basePoint='1' angle='0' length='{formula}'/>"
        );
        let tools = format!("{AXES}{ARC}{spline}{start}{lists}{tool}");
        let reading = read(&file("", &tools, ""));
        assert_eq!(reading.losses, [], "{formula}");
        assert_near(place(&reading, "P"), [value, 0.0], formula);
    }
}

#[test]
fn what_is_moved_may_be_turned_too() {
    // O to (3, 0), then a quarter round X: from 7 left of X to 7 below it.
    let lists = "<source><item idObject='1'/></source><destination><item idObject='21'/></destination></operation>";
    let turned = |centre: &str| {
        format!(
            "<operation type='moving' id='20' angle='0' length='3' rotationAngle='90' {centre} suffix='a1'>{lists}"
        )
    };
    let reading = read(&file("", &format!("{AXES}{}", turned("center='2'")), ""));
    assert_eq!(reading.losses, []);
    assert_near(place(&reading, "Oa1"), [10.0, -7.0], "round X");
    // Without a centre it turns round its own middle.
    let reading = read(&file("", &format!("{AXES}{}", turned("")), ""));
    assert_near(place(&reading, "Oa1"), [3.0, 0.0], "round itself");
}

#[test]
fn ellipses_follow_their_radii_and_may_be_given_by_a_length() {
    let tools = "<elArc type='simple' id='5' center='1' radius1='Line_O_X' radius2='5' angle1='0' angle2='90' rotationAngle='0'/>\
        <point type='endLine' id='9' name='P' basePoint='1' angle='0' length='Radius1ElArc_O_5-Radius2ElArc_O_5'/>\
        <point type='curveIntersectAxis' id='12' name='Q' curve='5' basePoint='1' angle='90'/>";
    let reading = read(&file("", &format!("{AXES}{tools}"), ""));
    assert_near(place(&reading, "P"), [5.0, 0.0], "radii");
    assert_near(place(&reading, "Q"), [0.0, 5.0], "the short axis");
    let sheet = &reading.pattern.sheets[0];
    let start = sheet.point_named("ElArc_O_5 0").unwrap();
    assert!(matches!(
        start.rule,
        toile_pattern::PointRule::Offset { .. }
    ));
    // A circle as an ellipse has its length where it should be: a quarter of 5 cm.
    let quarter = std::f64::consts::PI * 2.5;
    let tools = format!(
        "<elArc type='simple' id='5' center='1' radius1='5' radius2='5' angle1='0' length='{quarter}'/>\
         <point type='curveIntersectAxis' id='9' name='P' curve='5' basePoint='1' angle='45'/>\
         <point type='endLine' id='12' name='Q' basePoint='1' angle='0' length='ElArc_O_5'/>"
    );
    let reading = read(&file("", &format!("{AXES}{tools}"), ""));
    let half = 12.5_f64.sqrt();
    let off = (place(&reading, "P") - toile_geometry::Vec2::new(half, half)).norm();
    assert!(off < 1e-3, "{off}");
    let off = (place(&reading, "Q").x - quarter).abs();
    assert!(off < 1e-3, "{off}");
}
