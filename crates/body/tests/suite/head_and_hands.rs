//! Faces, ears and hands: there, on both sides alike, and no part of a girth.

use crate::common::is_sound;
use std::collections::HashSet;
use toile_body::{Figure, Joint, Loop, Mannequin, Scan, ScanLandmarks};
use toile_geometry::{TriangleMesh, Vec3};
use toile_measure::{Measurements, Origin};

const FIGURES: [Figure; 4] = [Figure::Woman, Figure::Man, Figure::Mean, Figure::Child8];

fn average(figure: Figure) -> Mannequin {
    Mannequin::new(&figure.average(), figure).unwrap()
}

/// Every vertex has its image: left and right are the same to the bit.
fn is_symmetric(mesh: &TriangleMesh) -> bool {
    let key = |p: &Vec3, side: f64| [(side * p.x + 0.0).to_bits(), p.y.to_bits(), p.z.to_bits()];
    let all: HashSet<[u64; 3]> = mesh.positions.iter().map(|p| key(p, 1.0)).collect();
    mesh.positions.iter().all(|p| all.contains(&key(p, -1.0)))
}

/// Breadth and depth of the head at a share of the stature (m).
fn head_at(scan: &Scan, share: f64) -> [f64; 2] {
    let loops = scan.level(share * scan.height());
    let largest = loops
        .iter()
        .max_by(|a, b| a.length().total_cmp(&b.length()));
    largest.map(Loop::extent).unwrap()
}

#[test]
fn heads_have_a_nose_and_ears_below_the_girth() {
    for figure in FIGURES {
        let body = average(figure);
        let scan = Scan::new(body.skin().clone(), ScanLandmarks::default()).unwrap();
        // The head's own length, crown to nape, says how large features are.
        let (height, head) = (scan.height(), body.taken("head_l").unwrap());
        let at = |under: f64| head_at(&scan, 1.0 - under * head / height);
        // Down the face from the brow to below the mouth what stands out most is the nose.
        let front: Vec<f64> = (0..40)
            .map(|k| {
                let y = height - head * (0.3 + 0.01 * f64::from(k));
                let near = (scan.level(y).into_iter())
                    .flat_map(|l| l.points)
                    .filter(|p| p.x.abs() < 0.06 * head);
                near.map(|p| p.y).fold(f64::NEG_INFINITY, f64::max)
            })
            .collect();
        let [foremost, brow] = [
            front.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            front[0],
        ];
        assert!(foremost > brow + 0.02 * head, "{figure:?}: {front:?}");
        // Ears make the head broader than it is above them, where it is taped.
        let broadest = (0..40)
            .map(|k| at(0.3 + 0.01 * f64::from(k))[0])
            .fold(0.0, f64::max);
        let above = body.taken("head_breadth").unwrap();
        assert!(
            broadest > above + 0.06 * head,
            "{figure:?}: {broadest} {above}"
        );
        let taped = body.taken("head").unwrap();
        assert!(
            (taped - body.completed().get("head").unwrap()).abs() < 5e-4,
            "{figure:?}"
        );
    }
}

#[test]
fn hands_have_closed_fingers_and_a_thumb_apart() {
    for figure in FIGURES {
        let body = average(figure);
        let scan = Scan::new(body.skin().clone(), ScanLandmarks::default()).unwrap();
        let [shoulder, wrist] =
            [Joint::LShoulder, Joint::LWrist].map(|joint| body.skeleton().centre(joint));
        let along = (wrist - shoulder).normalize();
        let far = |p: &Vec3| (p - wrist).dot(&along);
        let of_arm = |p: &&Vec3| (*p - wrist - along * far(p)).norm() < 0.06 * scan.height();
        let tip = (body.skin().positions.iter().filter(of_arm))
            .map(far)
            .fold(0.0, f64::max);
        let share = tip / scan.height();
        assert!(
            (0.095..0.125).contains(&share),
            "{figure:?}: a hand of {share}"
        );
        let across = [Vec3::z().cross(&along), Vec3::z()];
        let loops = |share: f64| {
            let near = |l: &Loop| l.centre().norm() < 0.6 * tip;
            let all = scan.section(wrist + along * (share * tip), across);
            all.into_iter().filter(near).collect::<Vec<Loop>>()
        };
        // One at the palm, thumb and fingers farther out, then the fingers as one group.
        assert_eq!(loops(0.15).len(), 1, "{figure:?}");
        assert_eq!(loops(0.47).len(), 2, "{figure:?}");
        assert_eq!(loops(0.75).len(), 1, "{figure:?}");
        // The palm is broad and flat, the wrist nearly round and not thinner than asked.
        let [thick, broad] = loops(0.75)[0].extent();
        assert!(broad > 2.0 * thick, "{figure:?}: {broad} {thick}");
        let asked = body.completed().get("wrist").unwrap();
        assert!(
            (body.taken("wrist").unwrap() - asked).abs() < 5e-4,
            "{figure:?}"
        );
    }
}

#[test]
fn skins_are_sound_and_alike_on_both_sides_at_every_size() {
    for (figure, sizes) in [
        (Figure::Woman, [(1.50, 0.80), (1.62, 1.10), (1.85, 0.92)]),
        (Figure::Man, [(1.60, 0.88), (1.78, 1.25), (2.0, 1.0)]),
        (Figure::Child4, [(0.95, 0.54), (1.0, 0.56), (1.08, 0.60)]),
    ] {
        for (height, bust) in sizes {
            let mut asked = Measurements::new();
            asked.set("height", height, Origin::Asked).unwrap();
            asked.set("bust", bust, Origin::Asked).unwrap();
            let body = Mannequin::new(&asked, figure).unwrap();
            assert!(is_sound(&body), "{figure:?} {height} {bust}");
            assert!(is_symmetric(body.skin()), "{figure:?} {height} {bust}");
            for name in ["head", "wrist", "neck", "bust", "waist", "hips"] {
                let asked = body.completed().get(name).unwrap();
                let gap = body.taken(name).unwrap() - asked;
                assert!(gap.abs() < 5e-4, "{figure:?} {height} {bust} {name}: {gap}");
            }
        }
    }
}
