//! Dress forms: the trunk of a woman of the same measurements, closed, on a stand.

use crate::common::is_sound;
use toile_body::{Figure, Mannequin, Part};
use toile_geometry::{Vec2, closed_length, convex_hull, horizontal_section};
use toile_measure::{Measurements, Origin};

/// Measurements of an average woman, and of small and large ones.
fn sizes() -> Vec<Measurements> {
    let mut sizes = vec![Measurements::new()];
    for (height, bust, waist, hips) in [
        (1.52, 0.80, 0.62, 0.86),
        (1.68, 0.92, 0.76, 0.99),
        (1.80, 1.22, 1.10, 1.28),
    ] {
        let mut table = Measurements::new();
        for (name, value) in [
            ("height", height),
            ("bust", bust),
            ("waist", waist),
            ("hips", hips),
        ] {
            table.set(name, value, Origin::Asked).unwrap();
        }
        sizes.push(table);
    }
    sizes
}

/// The level section of the whole surface at a height.
fn section(body: &Mannequin, height: f64) -> Vec<Vec2> {
    let mesh = body.skin();
    horizontal_section(mesh, 0..mesh.triangles.len(), height)
}

#[test]
fn a_dress_form_is_sound_at_every_size() {
    for (k, table) in sizes().iter().enumerate() {
        let form = Mannequin::new(table, Figure::DressForm).unwrap();
        assert!(is_sound(&form), "{k}");
        assert_eq!(form.part_of_triangle().len(), form.skin().triangles.len());
        let parts: Vec<Part> = form.parts().iter().map(|axis| axis.part).collect();
        assert_eq!(parts, [Part::Trunk, Part::Head]);
    }
}

#[test]
fn it_has_the_girths_of_a_woman_of_the_same_measurements() {
    for (k, table) in sizes().iter().enumerate() {
        let form = Mannequin::new(table, Figure::DressForm).unwrap();
        let woman = Mannequin::new(table, Figure::Woman).unwrap();
        let levels = form.levels();
        for (name, height) in [
            ("bust", levels.chest),
            ("waist", levels.waist),
            ("hips", levels.hip),
        ] {
            assert_eq!(form.taken(name), woman.taken(name), "{k} {name}");
            // Of the woman's section there without her arms.
            let mesh = woman.skin();
            let is_own = |t: &usize| woman.part_of_triangle()[*t] == Part::Trunk;
            let own = (0..mesh.triangles.len()).filter(is_own);
            let wanted = closed_length(&convex_hull(&horizontal_section(mesh, own, height)));
            let got = closed_length(&convex_hull(&section(&form, height)));
            assert!(
                (got - wanted).abs() < 5e-4,
                "{k} {name}: {got} for {wanted}"
            );
        }
    }
}

#[test]
fn it_has_no_head_arms_and_legs_and_stands() {
    for (k, table) in sizes().iter().enumerate() {
        let form = Mannequin::new(table, Figure::DressForm).unwrap();
        let woman = Mannequin::new(table, Figure::Woman).unwrap();
        let [low, high] = form.skin().bounds().unwrap();
        let marks = woman.landmarks();
        assert_eq!(low.y, 0.0);
        assert!(
            high.y > marks.nape.y && high.y < marks.crown.y - 0.15,
            "{k}: {high:?}"
        );
        assert!((form.levels().crown - high.y).abs() < 1e-12);
        // The ends of the shoulders are the outermost places above the hips' level, to a hand's breadth.
        assert!(
            high.x < 0.04 + marks.shoulder_tips[0].x.max(0.2),
            "{k}: {high:?}"
        );
        // Halfway to the floor there is the stand alone.
        let pole = section(&form, 0.5 * marks.crotch.y);
        assert!(pole.iter().all(|p| p.norm() < 0.1), "{k}");
        assert!(closed_length(&convex_hull(&pole)) < 0.11, "{k}");
        assert!(!form.contains(marks.crown) && form.contains(marks.spine[2]));
    }
}
