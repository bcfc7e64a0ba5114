//! The patterns that ship: real drafts in every size, without a single finding.

use toile_geometry::Vec2;
use toile_interchange::read_pattern;
use toile_measure::Measurements;
use toile_pattern::{Draft, DraftSeam, Pattern, Piece, SeamOrigin};

fn shipped(name: &str) -> Pattern {
    let path = format!(
        "{}/../../patterns/{name}.toile.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let (pattern, notes) = read_pattern(&std::fs::read_to_string(path).unwrap()).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    pattern
}

/// Every size of a pattern, and three bodies that no size was made for.
fn drafts(pattern: &Pattern) -> Vec<(String, Measurements, Draft)> {
    let sizes = pattern
        .sizes
        .iter()
        .map(|size| (size.name.clone(), size.measurements.clone()));
    let bodies = [
        ("woman", Measurements::adult_woman()),
        ("man", Measurements::adult_man()),
        ("adult", Measurements::adult()),
    ];
    let bodies = bodies.map(|(name, table)| (name.to_owned(), table));
    sizes
        .chain(bodies)
        .map(|(name, table)| {
            let found = pattern.check(&table);
            assert!(found.is_empty(), "{} {name}: {found:?}", pattern.name);
            let draft = pattern.resolve(&table).0;
            (name, table, draft)
        })
        .collect()
}

/// Area of a piece, holes taken out (m2).
fn area(piece: &Piece) -> f64 {
    let edges = piece.outline.iter().chain(piece.holes.iter().flatten());
    edges.map(|edge| edge.curve.swept_area()).sum::<f64>() * 0.5
}

/// Length of a side of a seam (m).
fn walked(draft: &Draft, seam: &DraftSeam, side: usize) -> f64 {
    let length = |span: &toile_pattern::DraftSpan| {
        let piece = &draft.pieces[span.piece];
        let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
        edges.nth(span.edge).unwrap().curve.length() * (span.to - span.from).abs()
    };
    seam.sides[side].iter().map(length).sum()
}

fn seam<'a>(draft: &'a Draft, name: &str) -> &'a DraftSeam {
    draft.seams.iter().find(|seam| seam.name == name).unwrap()
}

fn total_area(draft: &Draft) -> f64 {
    draft.pieces.iter().map(area).sum()
}

fn assert_grows(drafts: &[(String, Measurements, Draft)]) {
    for pair in drafts[..6].windows(2) {
        assert!(total_area(&pair[0].2) < total_area(&pair[1].2) * 0.99);
    }
}

#[test]
fn t_shirt_fits_in_every_size() {
    let pattern = shipped("t-shirt");
    let drafts = drafts(&pattern);
    assert_grows(&drafts);
    for (name, body, draft) in &drafts {
        assert_eq!(draft.pieces.len(), 4, "front, back and two sleeves");
        let bust = body.get("bust").unwrap();
        assert!(
            draft
                .pieces
                .iter()
                .all(|piece| piece.sewn && area(piece) > 0.0)
        );
        for side in ["left", "right"] {
            for half in ["front", "back"] {
                let armhole = seam(draft, &format!("{side} armhole {half}"));
                let [body, sleeve] = [0, 1].map(|k| walked(draft, armhole, k));
                assert!((body - sleeve).abs() < 0.005, "{name}: {body} {sleeve}");
                let share = body / bust;
                assert!((0.20..0.26).contains(&share), "{name}: {share} of the bust");
            }
        }
        let chest: f64 = ["front", "back"]
            .iter()
            .map(|panel| {
                let piece = draft.pieces.iter().find(|p| p.name == *panel).unwrap();
                let xs = piece.outline.iter().map(|edge| edge.curve.start().x);
                xs.clone().fold(f64::MIN, f64::max) - xs.fold(f64::MAX, f64::min)
            })
            .sum();
        let ease = chest - bust;
        assert!((0.10..0.16).contains(&ease), "{name}: bust ease {ease} m");
        assert!((0.6..1.0).contains(&total_area(draft)), "{name}");
    }
}

#[test]
fn skirt_is_gathered_into_a_band_that_fits_the_waist() {
    let pattern = shipped("gathered-skirt");
    let drafts = drafts(&pattern);
    assert_grows(&drafts);
    for (name, body, draft) in &drafts {
        let gathers = ["front gathers", "back gathers"].map(|n| seam(draft, n));
        let mut band = 0.0;
        for seam in gathers {
            assert!(seam.gathered);
            let [skirt, into] = [0, 1].map(|k| walked(draft, seam, k));
            assert!((1.5..1.8).contains(&(skirt / into)), "{name}");
            band += into;
        }
        let ease = band - body.get("waist").unwrap();
        assert!((0.01..0.02).contains(&ease), "{name}: {ease}");
    }
}

#[test]
fn trousers_have_matching_seams_and_room_at_the_hips() {
    let pattern = shipped("trousers");
    let drafts = drafts(&pattern);
    assert_grows(&drafts);
    for (name, body, draft) in &drafts {
        let darts = draft
            .seams
            .iter()
            .filter(|seam| matches!(seam.id, SeamOrigin::Dart { .. }))
            .count();
        assert_eq!(darts, 4, "two darts in each back");
        for seam in &draft.seams {
            let [a, b] = [0, 1].map(|k| walked(draft, seam, k));
            assert!((a - b).abs() < 1e-6, "{name}, {}: {a} {b}", seam.name);
        }
        let outseam = walked(draft, seam(draft, "left outseam"), 0);
        let inseam = walked(draft, seam(draft, "left inseam"), 0);
        let rise = outseam - inseam;
        assert!((0.2..0.4).contains(&rise), "{name}: {rise}");
        let waist: f64 = ["left", "right"]
            .iter()
            .flat_map(|side| ["front", "back"].map(|half| format!("{side} waist {half}")))
            .map(|name| walked(draft, seam(draft, &name), 1))
            .sum();
        let ease = waist - body.get("waist").unwrap();
        assert!((0.015..0.03).contains(&ease), "{name}: waist ease {ease}");
        let band = draft.pieces.iter().filter(|p| p.name == "waistband");
        let [band] = &band.collect::<Vec<_>>()[..] else {
            panic!("{name}: one waistband");
        };
        assert!(
            (area(band) - waist * 0.035).abs() < 1e-9,
            "{name}: the band is a strip as long as the waist"
        );
        let ends = [0, 1].map(|k| walked(draft, seam(draft, "waistband"), k));
        assert!(ends.iter().all(|end| (end - 0.035).abs() < 1e-12), "{name}");
        let crotch = walked(draft, seam(draft, "front rise"), 0)
            + walked(draft, seam(draft, "back rise"), 0);
        assert!((0.6..0.95).contains(&crotch), "{name}: {crotch}");
    }
}

#[test]
fn poncho_is_one_panel_with_a_hole_for_the_neck() {
    let pattern = shipped("poncho");
    let drafts = drafts(&pattern);
    assert_grows(&drafts);
    for (name, body, draft) in &drafts {
        let [piece] = &draft.pieces[..] else {
            panic!("{name}: one piece");
        };
        assert!(piece.sewn && piece.holes.len() == 1);
        let hole: f64 = piece.holes[0].iter().map(|e| e.curve.length()).sum();
        let neck = body.get("neck_w").unwrap() * std::f64::consts::PI;
        assert!(hole > neck && hole < neck * 1.6, "{name}: {hole}");
        assert!(draft.fabrics[0].nap);
    }
}

/// The stretches of a side of a seam between the darts it crosses: of each its length and the
/// distance of its ends (m).
fn stretches(draft: &Draft, seam: &DraftSeam, side: usize) -> Vec<[f64; 2]> {
    let piece = |span: &toile_pattern::DraftSpan| &draft.pieces[span.piece];
    let mut found: Vec<(f64, [Vec2; 2])> = Vec::new();
    for span in &seam.sides[side] {
        let curve = &piece(span).outline[span.edge].curve;
        let [from, to] = if span.from < span.to {
            [curve.start(), curve.end()]
        } else {
            [curve.end(), curve.start()]
        };
        match found.last_mut() {
            Some((length, ends)) if (ends[1] - from).norm() < 1e-9 => {
                *length += curve.length();
                ends[1] = to;
            }
            _ => found.push((curve.length(), [from, to])),
        }
    }
    let both = |(length, [from, to]): (f64, [Vec2; 2])| [length, (to - from).norm()];
    found.into_iter().map(both).collect()
}

#[test]
fn dress_has_darts_that_meet_at_the_waist_and_sides_that_true() {
    let pattern = shipped("dress");
    let drafts = drafts(&pattern);
    assert_grows(&drafts);
    for (name, body, draft) in &drafts {
        assert_eq!(
            draft.pieces.len(),
            6,
            "front, two backs, the same of the skirt"
        );
        assert!(draft.pieces.iter().all(|piece| piece.sewn));
        for seam in &draft.seams {
            let [a, b] = [0, 1].map(|k| walked(draft, seam, k));
            assert!((a - b).abs() < 1e-9, "{name}, {}: {a} {b}", seam.name);
        }
        let darts = |panel: &str| {
            let of = format!("of {panel}");
            let is_dart = |seam: &&DraftSeam| matches!(seam.id, SeamOrigin::Dart { .. });
            let all = draft.seams.iter().filter(is_dart);
            all.filter(|seam| seam.name.contains(&of)).count()
        };
        let panels = ["front bodice", "back bodice", "front skirt", "back skirt"];
        assert_eq!(panels.map(darts), [4, 4, 2, 4]);
        let mut waist = 0.0;
        for side in ["left", "right"] {
            for half in ["front", "back"] {
                let seam = seam(draft, &format!("{side} {half} waist"));
                let [bodice, skirt] =
                    [0, 1].map(|k| stretches(draft, seam, k).into_iter().map(|[l, _]| l));
                let [bodice, skirt]: [Vec<f64>; 2] = [bodice.collect(), skirt.collect()];
                let counts = if half == "front" { [2, 2] } else { [2, 3] };
                assert_eq!([bodice.len(), skirt.len()], counts, "{name}, {}", seam.name);
                // From the centre on: the darts meet where both first stretches end.
                assert!((bodice[0] - skirt[0]).abs() < 1e-9, "{name}, {}", seam.name);
                waist += bodice.iter().sum::<f64>();
            }
        }
        // Above and below the bust dart the front's side is straight, as the back's is.
        for side in ["left side", "right side"] {
            let front = stretches(draft, seam(draft, side), 0);
            assert_eq!(front.len(), 2, "{name}, {side}");
            let bent = front.iter().map(|[length, chord]| length - chord);
            assert!(bent.fold(0.0, f64::max) < 1e-9, "{name}, {side}: {front:?}");
        }
        let ease = waist - body.get("waist").unwrap();
        assert!((ease - 0.04).abs() < 1e-9, "{name}: waist ease {ease}");
        // About the dart's own end the angle is a little wider than about the bust point.
        let of_bust = |seam: &&DraftSeam| seam.name == "bust dart of front bodice";
        let bust = draft.seams.iter().find(of_bust).unwrap();
        let leg = |side: usize| &draft.pieces[0].outline[bust.sides[side][0].edge].curve;
        let [a, b] = [0, 1].map(|k| leg(k).end() - leg(k).start());
        let angle = a.perp(&-b).atan2(a.dot(&-b)).abs().to_degrees();
        assert!(
            (10.0..28.0).contains(&angle),
            "{name}: bust dart of {angle} degrees"
        );
        let hips: f64 = draft.pieces[3..]
            .iter()
            .chain(&draft.pieces[3..4])
            .map(|piece| {
                let at = |p: Vec2| (p.y + body.get("hips_line").unwrap()).abs();
                let ends = piece.outline.iter().map(|edge| edge.curve.start());
                let of_hips = ends.filter(|p| at(*p) < 1e-9).map(|p| p.x.abs());
                of_hips.fold(0.0, f64::max)
            })
            .sum();
        let ease = hips - body.get("hips").unwrap();
        assert!((ease - 0.06).abs() < 1e-9, "{name}: hip ease {ease}");
    }
}
