//! Selections of parts removed at once.

use super::*;
use crate::sample::{
    dart, edge, ends, formula_in, outline, point, put_line, put_operation, put_point, put_variable,
    sample,
};

fn removed(pattern: &Pattern, parts: &[PartId]) -> Pattern {
    let edits = plan::remove_parts(&evaluated(pattern), parts).unwrap();
    done(pattern, &edits)
}

/// The sample with everything that can be removed.
fn rich() -> Pattern {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    put_operation(&mut pattern, 0, "dart", kind);
    let wish = (
        outline(&pattern, "front"),
        Mark::between(ends(&pattern, "front", "right"), 0.5),
    );
    let panel = pattern.panels[0].id;
    let (edits, _) = plan::add_notch(&evaluated(&pattern), panel, wish, NotchKind::V).unwrap();
    pattern = done(&pattern, &edits);
    let number = formula_in(&pattern, "length(front.right) / 2");
    put_variable(&mut pattern, "half", number);
    let id = pattern.ids.take();
    pattern.sizes.push(std::sync::Arc::new(Size {
        id,
        name: "M".into(),
        measurements: Measurements::adult(),
    }));
    pattern.base_size = Some(id);
    pattern
}

#[test]
fn everything_can_be_removed_at_once() {
    let pattern = rich();
    let all: Vec<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
    let nothing = removed(&pattern, &all);
    assert!(nothing.parts().is_empty());
    assert_eq!(nothing.base_size, None);
}

#[test]
fn each_part_is_removed_alone_and_nothing_else_goes() {
    let pattern = rich();
    let front = &pattern.panels[0];
    let single: Vec<PartId> = vec![
        pattern.sizes[0].id.into(),
        pattern.variables[0].id.into(),
        pattern.fabrics[0].id.into(),
        pattern.sheets[0].id.into(),
        pattern.sheets[0].curves[0].id.into(),
        front.id.into(),
        front.operations[0].id.into(),
        front.notches[0].id.into(),
        pattern.seams[0].id.into(),
    ];
    for part in single {
        let after = removed(&pattern, &[part]);
        let left: HashSet<PartId> = after.parts().into_iter().map(|(id, _)| id).collect();
        let inside = |place: &Place| match (part, place) {
            (PartId::Sheet(id), Place::Point(p)) => pattern.point(*p).unwrap().0.id == id,
            (PartId::Sheet(id), Place::Curve(c)) => pattern.curve(*c).unwrap().0.id == id,
            (PartId::Panel(id), place) => matches!(place,
                Place::Line(p, _) | Place::Edge(p, _) | Place::Operation(p, _)
                | Place::Notch(p, _) if *p == id),
            _ => false,
        };
        for (id, place) in pattern.parts() {
            assert_eq!(left.contains(&id), id != part && !inside(&place), "{id}");
        }
    }
    // A removed curve suspends its panel, which comes back with it.
    let curve = pattern.sheets[0].curves[0].id;
    let after = removed(&pattern, &[curve.into()]);
    assert!(evaluated(&after).stage(front.id, None).is_none());
    assert!(evaluated(&pattern).stage(front.id, None).is_some());
}

#[test]
fn removed_corners_join_their_edges() {
    let pattern = rich();
    let corners = ["p1", "p2"].map(|name| point(&pattern, "front", name));
    for chosen in [&corners[..1], &corners[1..]] {
        let after = removed(&pattern, &[chosen[0].into()]);
        assert!(after.point(chosen[0]).is_none());
        for body in bodies() {
            assert!((area(&after, &body, after.panels[0].id) - 0.12).abs() < 1e-9);
        }
    }
    let both = corners.map(PartId::from);
    let told = refusal(
        plan::remove_parts(&evaluated(&pattern), &both)
            .map(|edits| {
                let after = done(&pattern, &edits);
                area(&after, &Measurements::adult(), after.panels[0].id)
            })
            .and_then(|area| match area.abs() < 1e-12 {
                true => Err(EditError::Missing("area".into())),
                false => Ok(area),
            }),
    );
    assert!(
        told.contains("area is not there"),
        "two edges are left: {told}"
    );
    let three = ["p1", "p2", "p3"].map(|name| PartId::from(point(&pattern, "front", name)));
    let told = refusal(plan::remove_parts(&evaluated(&pattern), &three));
    assert!(
        told.contains("remove the panel or the hole instead"),
        "{told}"
    );
    // With its panel it just goes.
    let panel = pattern.panels[0].id;
    let after = removed(&pattern, &[three.to_vec(), vec![panel.into()]].concat());
    assert_eq!(after.sheets[0].points.len(), 1);
}

#[test]
fn internal_lines_lose_edges_and_closed_ones_do_not() {
    let mut pattern = sample();
    let points = [0.1, 0.15, 0.2, 0.25, 0.3]
        .map(|x| put_point(&mut pattern, 0, &format!("x{x}"), PointRule::at(x, 0.1)));
    let line = put_line(&mut pattern, 0, ("slash", LineKind::Internal), &points);
    let before = pattern.clone();
    let edges: Vec<EdgeId> = pattern.panels[0]
        .line(line)
        .unwrap()
        .edges
        .iter()
        .map(|e| e.id)
        .collect();
    let after = removed(&pattern, &[edges[0].into()]);
    assert_eq!(after.panels[0].line(line).unwrap().edges.len(), 3);
    let after = removed(&pattern, &[edges[1].into()]);
    let lines: Vec<(&str, usize)> = after.panels[0]
        .lines
        .iter()
        .map(|l| (&*l.name, l.edges.len()))
        .collect();
    assert_eq!(lines, [("outline", 4), ("slash", 1), ("slash 2", 2)]);
    let all: Vec<PartId> = edges.iter().map(|&id| id.into()).collect();
    assert_eq!(removed(&pattern, &all).panels[0].lines.len(), 1);
    assert_eq!(removed(&pattern, &[line.into()]).panels[0].lines.len(), 1);
    assert_eq!(pattern, before);
    let evaluation = evaluated(&pattern);
    let side: PartId = edge(&pattern, "front", "right").into();
    let outline: PartId = outline(&pattern, "front").into();
    for (parts, says) in [
        (vec![side], "would be open without its edge \"right\""),
        (
            vec![outline],
            "would have no outline: remove the panel itself",
        ),
        (vec![PointId(9999).into()], "point 9999 is not there"),
    ] {
        let told = refusal(plan::remove_parts(&evaluation, &parts));
        assert!(told.contains(says), "{told}");
    }
    assert!(plan::remove_parts(&evaluation, &[]).unwrap().is_empty());
}

#[test]
fn a_corner_goes_even_where_its_curve_is_gone() {
    let pattern = sample();
    let curve = pattern.sheets[0].curves[1].id;
    let without = removed(&pattern, &[curve.into()]);
    let corner = point(&pattern, "front", "p2");
    let after = removed(&without, &[corner.into()]);
    assert!(evaluated(&after).stage(after.panels[0].id, None).is_some());
    for body in bodies() {
        assert!((area(&after, &body, after.panels[0].id) - 0.12).abs() < 1e-9);
    }
}
