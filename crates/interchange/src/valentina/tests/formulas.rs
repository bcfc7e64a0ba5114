//! Formulas of small files, each against its value worked out by hand.

use super::super::measurement_file;
use super::{AXES, evaluated, file, place, read, read_valentina};
use crate::exchange::Companion;
use toile_pattern::PointRule;

/// Measurements of the table of formulas.
const BODY: &str = "<vit><unit>cm</unit><body-measurements><m name='waist_circ' value='72'/>\
    <m name='height' value='170'/><m name='@Рост' value='12'/></body-measurements></vit>";

#[test]
fn formulas_have_the_values_of_a_table() {
    let increments = "<measurements>b.vit</measurements><increments>\
        <increment name='#ease' formula='4'/><increment name='#длина' formula='waist_circ/8'/>\
        <increment name='#a_b' formula='#ease*2'/><increment name='#share' formula='0.25'/>\
        <increment name='#twice' formula='(#длина+#ease)*2'/></increments>";
    let points = "<point type='single' id='1' name='O' x='0' y='0'/>\
        <point type='endLine' id='2' name='P_1' basePoint='1' angle='0' length='3'/>\
        <point type='endLine' id='3' name='Q_2' basePoint='1' angle='270' length='4'/>\
        <point type='endLine' id='4' name='P' basePoint='1' angle='0' length='7'/>";
    let pi = std::f64::consts::PI;
    for (formula, value) in [
        ("waist_circ/4+2", 20.0),
        ("#ease", 4.0),
        ("#a_b+#ease", 12.0),
        ("#длина", 9.0),
        ("#twice", 26.0),
        ("waist_circ*#share", 18.0),
        ("@Рост/2", 6.0),
        ("2*(3+4)-5/2", 11.5),
        ("2,5*2", 5.0),
        ("max(2,5)", 5.0),
        ("-2^2", -4.0),
        ("2^3", 8.0),
        ("(Line_O_P_1^2+Line_O_Q_2^2)^0.5", 5.0),
        ("sqrt(Line_O_P_1^2+16)", 5.0),
        ("9^(1/2)", 3.0),
        ("4^-1", 0.25),
        ("2^1.5", 8.0_f64.sqrt()),
        ("Line_P_1_Q_2", 5.0),
        ("Line_O_P_1", 3.0),
        ("AngleLine_O_Q_2/10", 27.0),
        ("360-AngleLine_O_Q_2", 90.0),
        ("AngleLine_P_1_O", 180.0),
        ("waist_circ>70?1:2", 1.0),
        ("waist_circ<70?1:waist_circ<=72?3:4", 3.0),
        (
            "(waist_circ<70 ? 1 : (height>=171 ? 5 : height/10)) + 1",
            18.0,
        ),
        ("waist_circ>70 && height<100 ? 1 : 2", 2.0),
        ("waist_circ>70 || height<100 ? 1 : 2", 1.0),
        ("waist_circ==72?#ease:0", 4.0),
        ("waist_circ!=72?#ease:7", 7.0),
        ("min(waist_circ; 50; height)", 50.0),
        ("max(1, 2, 3)", 3.0),
        ("abs(3-5)", 2.0),
        ("sum(1;2;waist_circ)", 75.0),
        ("avg(2;4;waist_circ)", 26.0),
        ("rint(waist_circ/7)", 10.0),
        ("rint(2.6)", 3.0),
        ("fmod(waist_circ;7)", 2.0),
        ("fmod(-7;4)", -3.0),
        ("fmod(8;4)", 0.0),
        ("sign(-3)*2", -2.0),
        ("sign(waist_circ)", 1.0),
        ("sin(_pi/6)*waist_circ", 36.0),
        ("cos(0)+tan(0)", 1.0),
        ("sinD(30)*10", 5.0),
        ("cosD(AngleLine_O_Q_2-210)", 0.5),
        ("tanD(45)*waist_circ", 72.0),
        ("atan(1)*180/_pi", 45.0),
        ("atanD(1)", 45.0),
        ("asinD(0.5)", 30.0),
        ("acosD(0.5)", 60.0),
        ("asin(1)*2", pi),
        ("acos(-1)", pi),
        ("atan2(1;1)*4", pi),
        ("radTodeg(_pi)", 180.0),
        ("degTorad(180)", pi),
        ("waist_circ*height", 72.0 * 170.0),
        ("Line_O_P_1*AngleLine_O_Q_2/180", 4.5),
        ("1/waist_circ*72", 1.0),
        ("0-0-0-0", 0.0),
        ("1e1+.5", 10.5),
        ("6/2/3*4", 4.0),
        ("5-(3-1)", 3.0),
        ("8/(4/2)", 4.0),
        ("-(-waist_circ)", 72.0),
    ] {
        let escaped = formula.replace('&', "&amp;").replace('<', "&lt;");
        let tool = format!(
            "{points}<point type='endLine' id='9' name='Z' basePoint='1' angle='0' length='{escaped}'/>"
        );
        let companion = Companion {
            name: "b.vit".to_owned(),
            bytes: BODY.as_bytes().to_vec(),
        };
        let text = file(increments, &tool, "");
        let reading = read_valentina(&text, &[companion]).unwrap();
        assert_eq!(reading.losses, [], "{formula}");
        let found = place(&reading, "Z").x;
        let off = (found - value).abs() / value.abs().max(1.0);
        assert!(off < 1e-12, "{formula}: {found}, not {value}");
    }
}

#[test]
fn simple_formulas_stay_readable() {
    let increments = "<increments><increment name='#ease' formula='2'/></increments>";
    let tool = "<point type='endLine' id='9' name='P' basePoint='1' angle='90 + 15' length='waist_circ/4+2-#ease'/>";
    let reading = read(&file(increments, &format!("{AXES}{tool}"), ""));
    let evaluation = evaluated(&reading);
    let point = reading.pattern.sheets[0].point_named("P").unwrap();
    let PointRule::Polar {
        distance, angle, ..
    } = &point.rule
    else {
        panic!("{:?}", point.rule);
    };
    let text = distance.as_formula().unwrap().text(evaluation.names());
    assert_eq!(text, "waist / 4 + 2cm - ease");
    assert_eq!(angle.value(), Some(105_f64.to_radians()));
    let ease = reading.pattern.variable_named("ease").unwrap();
    assert_eq!(evaluation.variable(ease.id), Some((0.02, 1)));
}

#[test]
fn lost_measurements_are_predicted_and_said() {
    let tool =
        "<point type='endLine' id='9' name='P' basePoint='1' angle='0' length='waist_circ+@mine'/>";
    let text = file(
        "<measurements>a/me.vit</measurements>",
        &format!("{AXES}{tool}"),
        "",
    );
    assert_eq!(measurement_file(&text).as_deref(), Some("a/me.vit"));
    let reading = read(&text);
    assert_eq!(reading.guesses.len(), 2, "{:?}", reading.guesses);
    assert!(reading.guesses[0].chosen.contains("waist_circ"));
    assert!(reading.guesses[0].because.contains("a/me.vit"));
    assert!(reading.guesses[1].chosen.contains("@mine"));
    assert_eq!(reading.losses, []);
    let found = place(&reading, "P").x;
    assert!((60.0..130.0).contains(&found), "{found}");
}
