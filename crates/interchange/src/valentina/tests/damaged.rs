//! Cycles, lost parts, newer versions, and files damaged at random.

use super::pieces::samples;
use super::{ARC, AXES, assert_near, file, place, read, read_valentina};
use crate::exchange::Companion;
use std::time::{Duration, Instant};

#[test]
fn cycles_are_left_out_by_name() {
    let tools = "<point type='endLine' id='7' name='A' basePoint='8' angle='0' length='1'/>\
        <point type='endLine' id='8' name='B' basePoint='7' angle='0' length='1'/>\
        <point type='endLine' id='9' name='C' basePoint='1' angle='0' length='Line_O_C'/>\
        <point type='endLine' id='10' name='P' basePoint='2' angle='0' length='1'/>";
    let increments = "<increments><increment name='#a' formula='#b+1'/><increment name='#b' formula='#a+1'/>\
        <increment name='#c' formula='#c'/></increments>";
    let reading = read(&file(increments, &format!("{AXES}{tools}"), ""));
    assert_near(place(&reading, "P"), [11.0, 0.0], "P");
    for name in ["\"A\"", "\"B\"", "\"C\"", "#a", "#b", "#c"] {
        let is_told = reading.losses.iter().any(|loss| loss.what.contains(name));
        assert!(is_told, "{name}: {:?}", reading.losses);
    }
    // Nodes that go round in a circle reach no object.
    let pieces = "<modeling><point id='101' idObject='102'/><point id='102' idObject='101'/></modeling>\
        <details><detail id='900' name='d'><nodes><node type='NodePoint' idObject='101'/>\
        <node type='NodePoint' idObject='1'/></nodes></detail></details>";
    let reading = read(&file("", AXES, pieces));
    assert_eq!(reading.pattern.panels.len(), 0);
    assert_eq!(reading.losses.len(), 2, "{:?}", reading.losses);
}

#[test]
fn lost_measurements_and_objects_are_told() {
    let tools =
        "<point type='endLine' id='9' name='P' basePoint='1' angle='0' length='waist_circ+@own'/>";
    let before = "<measurements>gone.vit</measurements>";
    let reading = read(&file(before, &format!("{AXES}{tools}"), ""));
    let told: Vec<&str> = reading.guesses.iter().map(|guess| guess.what).collect();
    assert_eq!(told, ["measurements", "unknown measurements"]);
    assert!(reading.guesses[0].because.contains("gone.vit"));
    let pieces = "<modeling><point id='101' idObject='77'/></modeling><details><detail id='900' name='d'><nodes>\
        <node type='NodePoint' idObject='101'/><node type='NodePoint' idObject='1'/>\
        <node type='NodePoint' idObject='2'/><node type='NodePoint' idObject='3'/></nodes></detail></details>";
    let reading = read(&file("", AXES, pieces));
    assert_eq!(reading.pattern.panels.len(), 1);
    assert!(reading.losses[0].why.contains("77"), "{:?}", reading.losses);
}

#[test]
fn files_of_newer_versions_are_read_and_said() {
    let tools = "<spline type='parallelCurve' id='7' curve='1' width='2'/>";
    for (version, is_newer) in [
        ("0.2.4", false),
        ("1.2.1", false),
        ("1.2.2", true),
        ("2.0.0", true),
        ("many", true),
    ] {
        let text = file("", &format!("{AXES}{tools}"), "").replace("0.4.0", version);
        let reading = read(&text);
        assert_eq!(
            reading.notes.len(),
            usize::from(is_newer),
            "{version}: {:?}",
            reading.notes
        );
        if is_newer {
            assert!(reading.notes[0].contains(version));
        }
        // Tools that are not known are named.
        assert_eq!(reading.losses.len(), 1);
        assert!(reading.losses[0].what.contains("parallelCurve"));
    }
    let seamly = "<pattern><version>0.8.0</version><unit>cm</unit><draftBlock name='d'><calculation/></draftBlock></pattern>";
    let reading = read(seamly);
    assert!(reading.notes[0].contains("Seamly2D"), "{:?}", reading.notes);
}

/// Measurements of the files below.
const BODY: &str = "<vit><unit>cm</unit><body-measurements><m name='waist_circ' value='72'/>\
    <m name='height' value='(waist_circ+98)'/><m name='@own' value='12'/></body-measurements></vit>";

/// A file with tools and pieces of most kinds, and the shared samples where they are, each with a body.
fn sources() -> Vec<(String, String)> {
    let increments = "<measurements>b.vit</measurements><increments><increment name='#ease' formula='waist_circ/9'/>\
        <increment name='#turn' formula='(#ease&gt;3 ? 30 : 45)'/></increments>";
    let tools = "<line id='4' firstPoint='1' secondPoint='2'/>\
        <point type='alongLine' id='6' name='L' firstPoint='1' secondPoint='2' length='CurrentLength/3'/>\
        <point type='normal' id='7' name='N' firstPoint='6' secondPoint='2' angle='#turn' length='#ease'/>\
        <point type='bisector' id='8' name='B' firstPoint='2' secondPoint='1' thirdPoint='3' length='4'/>\
        <point type='height' id='9' name='H' basePoint='8' p1Line='2' p2Line='3'/>\
        <point type='shoulder' id='10' name='S' p1Line='1' p2Line='2' pShoulder='3' length='20'/>\
        <point type='triangle' id='11' name='T' axisP1='1' axisP2='8' firstPoint='2' secondPoint='3'/>\
        <point type='pointOfContact' id='12' name='K' firstPoint='1' secondPoint='2' center='8' radius='5'/>\
        <point type='pointOfIntersectionCircles' id='13' name='Z' c1Center='1' c2Center='2' c1Radius='6' c2Radius='8' crossPoint='1'/>\
        <point type='cutArc' id='14' name='C' arc='5' length='Arc_O_5/2'/>\
        <point type='curveIntersectAxis' id='17' name='V' basePoint='1' curve='5' angle='30'/>\
        <spline type='simple' id='20' point1='2' point4='3' angle1='90' angle2='0' kAsm1='1' kAsm2='1' kCurve='1'/>\
        <spline type='pathInteractive' id='21'><pathPoint pSpline='1' angle1='180' length1='0' angle2='10' length2='2'/>\
        <pathPoint pSpline='7' angle1='180' length1='1' angle2='0' length2='1'/>\
        <pathPoint pSpline='2' angle1='90' length1='2' angle2='0' length2='0'/></spline>\
        <elArc type='simple' id='22' center='1' radius1='6' radius2='3' angle1='0' angle2='180' rotationAngle='20'/>\
        <operation type='flippingByLine' id='30' p1Line='1' p2Line='3' suffix='m'><source><item idObject='2'/>\
        <item idObject='5'/></source><destination><item idObject='31'/><item idObject='32'/></destination></operation>";
    let pieces = "<modeling><point id='101' idObject='1'/><point id='102' idObject='2'/><point id='103' idObject='3'/>\
        <spline id='104' idObject='20'/></modeling><details><detail id='200' name='front' version='2' seamAllowance='1' \
        width='1'><data quantity='2'/><grainline visible='true' rotation='90'/><mirrorLine p1='101' p2='103'/><nodes>\
        <node type='NodePoint' idObject='101' after='2' passmark='1'/><node type='NodePoint' idObject='102'/>\
        <node type='NodeSpline' idObject='104'/><node type='NodePoint' idObject='103'/></nodes></detail></details>";
    let own = file(increments, &format!("{AXES}{ARC}{tools}"), pieces);
    let mut all = vec![(own, BODY.to_owned())];
    if let Some(folder) = samples() {
        for (text, body) in [
            ("valentina/Keiko_skirt.val", "valentina/keiko.vit"),
            ("valentina/TestDart.val", "valentina/keiko.vit"),
            ("seamly/trousers.sm2d", "seamly/trousers.smis"),
        ] {
            let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
            all.push((read(text), read(body)));
        }
    }
    all
}

/// A generator of numbers, the same in each run.
struct Random(u64);

impl Random {
    fn next(&mut self, below: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % below.max(1)
    }
}

/// A text with some of its parts damaged.
fn damaged(text: &str, random: &mut Random) -> String {
    const PIECES: &[&str] = &[
        "", "0", "-1", "1e309", "NaN", "\"", "<", "/>", "(", ")", "?", ":", "-9999999", "Line_A_A",
        "1/0", "id=", "^", "\u{416}",
    ];
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=random.next(4) {
        let at = random.next(bytes.len());
        let end = (at + random.next(12)).min(bytes.len());
        match random.next(4) {
            0 => drop(bytes.drain(at..end)),
            1 => {
                let piece = PIECES[random.next(PIECES.len())];
                bytes.splice(at..end, piece.bytes());
            }
            2 => {
                // A number becomes another: references point elsewhere, lengths change.
                let digits = bytes.iter().enumerate().skip(at);
                let found = digits
                    .filter(|(_, byte)| byte.is_ascii_digit())
                    .map(|(k, _)| k)
                    .next();
                if let Some(k) = found {
                    bytes[k] = b'0' + random.next(10) as u8;
                }
            }
            _ => {
                let to = random.next(bytes.len());
                let part: Vec<u8> = bytes[at..end].to_vec();
                bytes.splice(to..to, part);
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn the_file_that_is_damaged_below_is_read_without_a_loss_but_that_of_its_ellipse() {
    let (text, body) = &sources()[0];
    let companion = Companion {
        name: "b.vit".to_owned(),
        bytes: body.clone().into_bytes(),
    };
    let reading = read_valentina(text, &[companion]).unwrap();
    assert_eq!(reading.losses.len(), 1, "{:?}", reading.losses);
    assert_eq!(reading.pattern.panels.len(), 1);
}

#[test]
fn files_damaged_at_random_are_read_or_refused_in_time() {
    let mut random = Random(7);
    let sources = sources();
    let (mut read, mut refused) = (0, 0);
    let mut slowest = Duration::ZERO;
    for k in 0..1000 {
        let (text, body) = &sources[k % sources.len()];
        let text = damaged(text, &mut random);
        let body = match random.next(4) {
            0 => damaged(body, &mut random),
            _ => body.clone(),
        };
        let companion = Companion {
            name: "b.vit".to_owned(),
            bytes: body.into_bytes(),
        };
        let start = Instant::now();
        match read_valentina(&text, &[companion]) {
            Ok(_) => read += 1,
            Err(error) => {
                assert!(!error.place.is_empty() && !error.hint.is_empty(), "{error}");
                refused += 1;
            }
        }
        slowest = slowest.max(start.elapsed());
    }
    assert!(read > 50 && refused > 50, "{read} read, {refused} refused");
    assert!(slowest < Duration::from_secs(2), "{slowest:?}");
}
