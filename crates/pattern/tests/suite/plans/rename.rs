//! Parts renamed: formulas follow, and names stay unique.

use super::*;
use crate::sample::{dart, edge, formula_in, outline, point, put_operation, put_variable, sample};

fn rich() -> Pattern {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    put_operation(&mut pattern, 0, "dart", kind.clone());
    let number = formula_in(&pattern, "length(front.right) + y(front.p2)");
    put_variable(&mut pattern, "reach", number);
    put_variable(&mut pattern, "other", 0.0.into());
    let (edits, _) =
        plan::add_size(&evaluated(&pattern), Some("M"), Measurements::adult()).unwrap();
    done(&pattern, &edits)
}

#[test]
fn every_kind_of_part_can_be_renamed() {
    let pattern = rich();
    let evaluation = evaluated(&pattern);
    let value = evaluation.variable(pattern.variables[0].id).unwrap();
    for (part, place) in pattern.parts() {
        let edits = plan::rename(&evaluation, part, "new name").unwrap();
        assert_eq!(edits.len(), 1);
        let after = done(&pattern, &edits);
        let told = after.describe(&place);
        assert!(told.ends_with("\"new name\""), "{told}");
        let again = Evaluation::new(&after, &Measurements::adult());
        assert_eq!(again.variable(pattern.variables[0].id).unwrap(), value);
    }
    let right = edge(&pattern, "front", "right").into();
    assert!(
        plan::rename(&evaluation, right, "right")
            .unwrap()
            .is_empty()
    );
}

#[test]
fn taken_names_are_refused_with_their_owner() {
    let mut pattern = rich();
    pattern.sheets.iter_mut().for_each(|sheet| {
        let sheet = std::sync::Arc::make_mut(sheet);
        sheet.name = format!("{} draft", sheet.name);
    });
    let evaluation = evaluated(&pattern);
    let front = &pattern.panels[0];
    let sheet = &pattern.sheets[0];
    for (part, name, says) in [
        (
            pattern.seams[0].id.into(),
            "other side",
            "which seam \"other side\" has",
        ),
        (front.id.into(), "back", "which panel \"back\" has"),
        (
            front.id.into(),
            "back draft",
            "which sheet \"back draft\" has",
        ),
        (sheet.id.into(), "back", "which panel \"back\" has"),
        (
            sheet.id.into(),
            "back draft",
            "which sheet \"back draft\" has",
        ),
        (
            point(&pattern, "front", "p0").into(),
            "p1",
            "point \"p1\" of sheet \"front draft\"",
        ),
        (sheet.curves[0].id.into(), "top", "curve \"top\" of sheet"),
        (
            edge(&pattern, "front", "top").into(),
            "left",
            "edge \"left\" of panel \"front\"",
        ),
        (
            pattern.variables[0].id.into(),
            "other",
            "which variable \"other\" has",
        ),
        (pattern.variables[0].id.into(), "bust", "is a measurement"),
        (outline(&pattern, "front").into(), "a'b", "cannot be a name"),
        (PartId::Point(PointId(9999)), "x", "point 9999 is not there"),
        (PartId::Edge(EdgeId(9999)), "x", "edge 9999 is not there"),
    ] {
        let told = refusal(plan::rename(&evaluation, part, name));
        assert!(told.contains(says), "{told}");
    }
    // A sheet and the panel traced from it may share a name.
    let edits = plan::rename(&evaluation, sheet.id.into(), "front").unwrap();
    assert_eq!(done(&pattern, &edits).sheets[0].name, "front");
}

#[test]
fn formulas_that_wait_for_a_name_find_it() {
    let mut pattern = sample();
    let of_text = |text: &str, pattern: &Pattern| formula_in(pattern, text);
    let waiting = of_text("ease + length(front.armhole)", &pattern);
    put_variable(&mut pattern, "waiting", waiting);
    let both = of_text("ease * 2", &pattern);
    crate::sample::alter(&mut pattern, 0, |panel| {
        panel.allowance = both.clone();
        panel.lines[0].edges[0].allowance = Some(both);
    });
    let lost = put_variable(&mut pattern, "lost", 1.0.into());
    let with_lost = of_text("lost * ease", &pattern);
    put_variable(&mut pattern, "with lost", with_lost.clone());
    pattern.apply(&[Edit::Remove(lost.into())]).unwrap();
    let waiting = pattern.variables[0].id;
    assert_eq!(evaluated(&pattern).variable(waiting), None);
    let length = crate::sample::formula("2cm");
    let (edits, ease) = plan::add_variable(&evaluated(&pattern), Some("ease"), length).unwrap();
    let pattern = done(&pattern, &edits);
    assert_eq!(
        evaluated(&pattern).variable(waiting),
        None,
        "one name is there, one is not"
    );
    let right = edge(&pattern, "front", "right");
    let edits = plan::rename(&evaluated(&pattern), right.into(), "armhole").unwrap();
    let pattern = done(&pattern, &edits);
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, &body);
        assert!((evaluation.variable(waiting).unwrap().0 - 0.62).abs() < 1e-12);
        let stage = evaluation.stage(pattern.panels[0].id, None).unwrap();
        assert!(
            stage
                .outline()
                .iter()
                .all(|edge| (edge.allowance - 0.04).abs() < 1e-12)
        );
    }
    assert_eq!(
        pattern.variables[1].number, with_lost,
        "it keeps what was removed"
    );
    // It is bound to the variable, not to its name.
    let edits = plan::rename(&evaluated(&pattern), ease.into(), "fullness").unwrap();
    let pattern = done(&pattern, &edits);
    assert!(evaluated(&pattern).variable(waiting).is_some());
}
