//! What formulas name keeps its meaning: printed and read again, after parts were removed, renamed
//! and brought back.

use crate::sample::*;
use proptest::prelude::*;
use std::sync::Arc;
use toile_measure::Measurements;
use toile_pattern::*;

/// The sample with a part of every kind that formulas can name.
fn named_sample() -> Pattern {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    put_operation(&mut pattern, 0, "dart", kind);
    put_variable(&mut pattern, "ease", formula("2cm"));
    put_variable(&mut pattern, "wide ease", formula("3cm"));
    let id = pattern.ids.take();
    let mut measurements = Measurements::adult();
    let own = toile_measure::Origin::Asked;
    measurements.set("my_own", 0.3, own).unwrap();
    let name = "M".into();
    pattern.sizes.push(Arc::new(Size {
        id,
        name,
        measurements,
    }));
    pattern
}

/// Formulas that name parts of every kind.
fn formulas(pattern: &Pattern) -> Vec<Formula> {
    let names = Names::new(pattern);
    let mut all: Vec<Formula> = [
        "ease + 'wide ease' * 2",
        "bust / 4 + my_own",
        "x(front.p1) + y(back.p2)",
        "distance(front.p0, back.p3)",
        "angle(front.p0, front.p2) + angle(front.right)",
        "length(front.right) + finished(back.left)",
        "length(front.p0..front.p2) + finished(back.p3..back.p1)",
        "length('one side') + length('other side')",
        "length(nowhere.edge) + nothing + x(front.nothing)",
    ]
    .iter()
    .map(|text| Formula::parse(text, &names).unwrap())
    .collect();
    // A curve is called like its edge, and a corner that an operation made is drawn by no point.
    let curve = pattern.sheets[0].curves[1].id.0;
    let panel = pattern.panels[0].id.0;
    let dart = pattern.panels[0].operations[0].id.0;
    let point = pattern.sheets[0].points[3].id.0;
    for text in [
        format!("length(@c{curve}) * 2"),
        format!("length(@e{panel}:{dart}.mouth.1:{point})"),
        format!("finished(@e{panel}:{point}:{dart}.apex.0)"),
    ] {
        all.push(serde_json::from_value(text.into()).unwrap());
    }
    all
}

/// Everything that can be taken out or renamed.
fn parts(pattern: &Pattern) -> Vec<PartId> {
    pattern.parts().into_iter().map(|(id, _)| id).collect()
}

fn remove(pattern: &mut Pattern, part: PartId) {
    let removal = Edit::Remove(part);
    if pattern.apply(&[removal]).is_ok() {
        return;
    }
    for panel in &mut pattern.panels {
        let panel = Arc::make_mut(panel);
        panel.operations.retain(|o| PartId::from(o.id) != part);
        panel.lines.retain(|line| PartId::from(line.id) != part);
        for line in &mut panel.lines {
            line.edges.retain(|edge| PartId::from(edge.id) != part);
        }
    }
}

/// Names that parts of all kinds are given, so that many share one.
const RENAMES: [&str; 8] = [
    "front", "back", "right", "p1", "ease", "bust", "dart", "a.b",
];

fn rename(pattern: &mut Pattern, part: PartId, name: &str) {
    let give = |old: &mut String| name.clone_into(old);
    for variable in &mut pattern.variables {
        if part == variable.id.into() {
            give(&mut Arc::make_mut(variable).name);
        }
    }
    for sheet in &mut pattern.sheets {
        let sheet = Arc::make_mut(sheet);
        if part == sheet.id.into() {
            give(&mut sheet.name);
        }
        for point in &mut sheet.points {
            if part == point.id.into() {
                give(&mut Arc::make_mut(point).name);
            }
        }
        for curve in &mut sheet.curves {
            if part == curve.id.into() {
                give(&mut Arc::make_mut(curve).name);
            }
        }
    }
    for panel in &mut pattern.panels {
        let panel = Arc::make_mut(panel);
        if part == panel.id.into() {
            give(&mut panel.name);
        }
        for edge in panel.lines.iter_mut().flat_map(|line| &mut line.edges) {
            if part == edge.id.into() {
                give(&mut edge.name);
            }
        }
        for operation in &mut panel.operations {
            if part == operation.id.into() {
                give(&mut Arc::make_mut(operation).name);
            }
        }
    }
    for seam in &mut pattern.seams {
        if part == seam.id.into() {
            give(&mut Arc::make_mut(seam).name);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn a_printed_formula_reads_as_the_same(
        removed in prop::collection::vec(any::<prop::sample::Index>(), 0..8),
        renamed in prop::collection::vec((any::<prop::sample::Index>(), 0..RENAMES.len()), 0..12),
    ) {
        let mut pattern = named_sample();
        let formulas = formulas(&pattern);
        let parts = parts(&pattern);
        for (part, name) in renamed {
            rename(&mut pattern, *part.get(&parts), RENAMES[name]);
        }
        for part in removed {
            remove(&mut pattern, *part.get(&parts));
        }
        let names = Names::new(&pattern);
        for formula in formulas {
            let text = formula.text(&names);
            let again = Formula::parse(&text, &names);
            prop_assert_eq!(again.as_ref(), Ok(&formula), "{}", text);
        }
    }
}

#[test]
fn names_print_plainly_while_they_are_unambiguous() {
    let mut pattern = named_sample();
    let formulas = formulas(&pattern);
    let texts = |pattern: &Pattern| -> Vec<String> {
        let names = Names::new(pattern);
        formulas.iter().map(|f| f.text(&names)).collect()
    };
    let before = texts(&pattern);
    assert_eq!(before[2], "x(front.p1) + y(back.p2)");
    assert_eq!(before[9], "length(curve front.right) * 2");
    assert_eq!(before[10], "length(front.dart.mouth.1..front.p3)");
    let sheet = pattern.sheets[0].id;
    rename(&mut pattern, sheet.into(), "draft");
    assert_eq!(texts(&pattern)[9], "length(draft.right) * 2");
    let lost = pattern.sheets[0].points[3].id;
    remove(&mut pattern, lost.into());
    let text = format!("length(front.dart.mouth.1..front.?{})", lost.0);
    assert_eq!(texts(&pattern)[10], text);
    // A variable that is called like a measurement takes nothing from those who name that.
    let ease = pattern.variables[0].id;
    rename(&mut pattern, ease.into(), "bust");
    let now = texts(&pattern);
    assert_eq!(now[0], "bust + 'wide ease' * 2");
    assert_eq!(now[1], "measurement bust / 4 + my_own");
}

/// Names are as long as their parts like; only what stands around them is counted.
#[test]
fn long_names_do_not_make_a_formula_unreadable() {
    let mut pattern = named_sample();
    let text = format!("ease{}", " + ease".repeat(300));
    let formula = Formula::parse(&text, &Names::new(&pattern)).unwrap();
    let ease = pattern.variables[0].id;
    rename(&mut pattern, ease.into(), &"ü".repeat(80));
    let names = Names::new(&pattern);
    let printed = formula.text(&names);
    assert!(printed.len() > 40_000);
    assert_eq!(Formula::parse(&printed, &names), Ok(formula));
}

/// What a formula asked for in vain is found when something is called so, and a name that led
/// somewhere goes on leading there.
#[test]
fn names_that_were_nothings_are_found_when_they_come() {
    let mut pattern = named_sample();
    for (name, text) in [("waiting", "late + 1cm"), ("third", "length(right) + 1cm")] {
        let number = formula_in(&pattern, text);
        put_variable(&mut pattern, name, number);
    }
    let ease = formula_in(&pattern, "ease");
    alter_seam(&mut pattern, 0, |seam| seam.ease = ease);
    let value = |pattern: &Pattern, name: &str| {
        let variable = pattern.variable_named(name).unwrap().id;
        Evaluation::new(pattern, &Measurements::adult()).variable(variable)
    };
    assert_eq!(value(&pattern, "waiting"), None);
    assert_eq!(value(&pattern, "third"), None);
    put_variable(&mut pattern, "late", formula("2cm"));
    assert_eq!(value(&pattern, "waiting"), Some((0.03, 1)));
    let seam = pattern.seams[0].id;
    alter_seam(&mut pattern, 0, |seam| seam.name = "right".into());
    let (found, _) = value(&pattern, "third").unwrap();
    assert!(
        (found - 0.61).abs() < 1e-12,
        "a side and a centimetre: {found}"
    );
    assert!(pattern.users(seam.into()).contains(&Place::Variable(
        pattern.variable_named("third").unwrap().id
    )));
    // The ease that the seam's formula was bound to is another name's by now.
    let ease = pattern.variable_named("ease").unwrap().id;
    let before = value(&pattern, "ease");
    Arc::make_mut(pattern.variables.iter_mut().find(|v| v.id == ease).unwrap()).name = "e".into();
    put_variable(&mut pattern, "ease", formula("1m"));
    assert_eq!(value(&pattern, "e"), before);
    assert!(pattern.users(ease.into()).contains(&Place::Seam(seam)));
}

/// What is removed and not known of which kind it was comes back with its id.
#[test]
fn a_lost_part_comes_back_by_its_id() {
    let mut pattern = named_sample();
    let seam = pattern.seams[1].id;
    let text = format!("length(?{0}) + length(seam ?{0})", seam.0);
    let gone = Edit::Remove(seam.into());
    let back = Edit::Put(Entity::Seam(pattern.seams[1].clone()));
    pattern.apply(&[gone]).unwrap();
    let number = formula_in(&pattern, &text);
    let variable = put_variable(&mut pattern, "both", number);
    let mut evaluation = Evaluation::new(&pattern, &Measurements::adult());
    assert_eq!(evaluation.variable(variable), None);
    pattern.apply(&[back]).unwrap();
    evaluation.update(&pattern, &Measurements::adult());
    let (value, power) = evaluation.variable(variable).unwrap();
    assert!((value - 1.2).abs() < 1e-9 && power == 1, "{value}");
}
