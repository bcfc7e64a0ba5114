//! Random runs of planners and raw edits on the patterns that ship: after every edit the evaluation
//! that was kept up to date equals a fresh one to the bit, and only dependants were computed.

use super::sequences::{Wish, wished};
use super::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

const PATTERNS: [&str; 5] = [
    include_str!("../../../../../patterns/t-shirt.toile.json"),
    include_str!("../../../../../patterns/gathered-skirt.toile.json"),
    include_str!("../../../../../patterns/trousers.toile.json"),
    include_str!("../../../../../patterns/poncho.toile.json"),
    include_str!("../../../../../patterns/dress.toile.json"),
];
/// Runs, and edits of each.
const RUNS: u64 = 500;
const EDITS: usize = 20;

/// Random numbers by a seed (Steele, Lea and Flood 2014, SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn wish(&mut self) -> Wish {
        let numbers = [(); 4].map(|()| self.next() as u16);
        let places = [(-0.2, 0.8), (-0.2, 0.8), (-0.2, 1.2)];
        let places = places.map(|(low, high)| self.between(low, high));
        (self.next() as u8, numbers, places)
    }
}

/// A raw edit: a part put otherwise, taken away, or moved in its list.
fn raw(pattern: &Pattern, random: &mut Random) -> Vec<Edit> {
    let parts: Vec<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
    if parts.is_empty() {
        return Vec::new();
    }
    let part = parts[random.below(parts.len())];
    let edit = match random.below(5) {
        0 | 1 => Edit::Remove(part),
        2 => Edit::Order {
            part,
            at: random.below(6),
        },
        3 => match moved(pattern, random) {
            Some(edit) => edit,
            None => return Vec::new(),
        },
        _ => match thinned(pattern, random) {
            Some(edit) => edit,
            None => return Vec::new(),
        },
    };
    vec![edit]
}

/// A point put somewhere, or made from another.
fn moved(pattern: &Pattern, random: &mut Random) -> Option<Edit> {
    let sheet = pattern.sheets.get(random.below(pattern.sheets.len()))?;
    let point = sheet.points.get(random.below(sheet.points.len()))?;
    let base = sheet.points.get(random.below(sheet.points.len()))?.id;
    let [x, y] = [(); 2].map(|()| random.between(-0.3, 0.9));
    let rule = match random.below(3) {
        0 => PointRule::at(x, y),
        1 => PointRule::Offset {
            base,
            x: x.into(),
            y: crate::sample::formula("waist / 10"),
        },
        _ => PointRule::at(0.1, 0.1),
    };
    let put = Point {
        rule,
        ..(**point).clone()
    };
    Some(Edit::Put(Entity::Point(sheet.id, Arc::new(put))))
}

/// A panel put without one of its parts, or cut another number of times.
fn thinned(pattern: &Pattern, random: &mut Random) -> Option<Edit> {
    let panel = pattern.panels.get(random.below(pattern.panels.len()))?;
    let mut put = (**panel).clone();
    match random.below(4) {
        0 if !put.notches.is_empty() => drop(put.notches.remove(random.below(put.notches.len()))),
        1 if !put.operations.is_empty() => {
            drop(put.operations.remove(random.below(put.operations.len())));
        }
        2 if !put.lines.is_empty() => {
            let line = random.below(put.lines.len());
            let edges = &mut put.lines[line].edges;
            if !edges.is_empty() {
                edges.remove(random.below(edges.len()));
            }
        }
        _ => put.cut.quantity = random.below(4) as u32,
    }
    Some(Edit::Put(Entity::Panel(Arc::new(put))))
}

/// Everything an evaluation says, to the bit, by part.
fn said(evaluation: &Evaluation) -> BTreeMap<PartId, Vec<u64>> {
    let pattern = evaluation.pattern();
    let mut all: BTreeMap<PartId, Vec<u64>> = BTreeMap::new();
    let bits = |p: &Vec2| [p.x.to_bits(), p.y.to_bits()];
    for ((_, id), place) in evaluation.points() {
        all.insert(id.into(), bits(&place).to_vec());
    }
    let path = |path: &toile_geometry::Path| -> Vec<u64> {
        let curves = path.curves().iter();
        let points = curves.flat_map(|curve| curve.defining_points());
        points.flat_map(|p| bits(&p)).collect()
    };
    for curve in pattern.sheets.iter().flat_map(|sheet| &sheet.curves) {
        if let Some(found) = evaluation.curve(curve.id) {
            all.insert(curve.id.into(), path(found));
        }
    }
    for edge in pattern.panels.iter().flat_map(|panel| panel.edges()) {
        if let Some(found) = evaluation.edge(edge.id) {
            all.insert(edge.id.into(), path(found));
        }
    }
    for variable in &pattern.variables {
        if let Some((value, power)) = evaluation.variable(variable.id) {
            all.insert(variable.id.into(), vec![value.to_bits(), power as u64]);
        }
    }
    all
}

/// Asserts that an evaluation equals a fresh one to the bit.
fn equals_fresh(kept: &Evaluation, what: &str) {
    let fresh = Evaluation::new(kept.pattern(), kept.wearer());
    assert_eq!(said(kept), said(&fresh), "{what}");
    for panel in &kept.pattern().panels {
        let operations = panel.operations.iter().map(|o| Some(o.id));
        for after in std::iter::once(None).chain(operations) {
            match [kept, &fresh].map(|evaluation| evaluation.stage(panel.id, after)) {
                [Some(a), Some(b)] => assert!(a.is_same(b), "{what}: {:?} {after:?}", panel.name),
                [a, b] => assert_eq!(a.is_some(), b.is_some(), "{what}: {:?}", panel.name),
            }
        }
    }
    // Seams have their values in the draft.
    assert_eq!(kept.draft(), fresh.draft(), "{what}");
    assert_eq!(kept.names(), fresh.names(), "{what}");
}

/// A number for the stage a sheet lies on, which says what its points and inserts are drawn on.
fn stage_of(sheet: &Sheet) -> usize {
    sheet.on.map_or(1, |(panel, after)| {
        2 + 3 * panel.0 as usize + 100_003 * after.map_or(0, |by| by.0 as usize)
    })
}

/// Nodes whose definitions differ in two patterns.
fn differing(before: &Pattern, now: &Pattern) -> BTreeSet<Node> {
    /// Each node with the address of what defines it.
    fn defined(pattern: &Pattern) -> BTreeSet<(Node, usize)> {
        fn at<T>(part: &Arc<T>) -> usize {
            Arc::as_ptr(part) as usize
        }
        let mut all = BTreeSet::new();
        all.extend(
            pattern
                .variables
                .iter()
                .map(|v| (Node::Variable(v.id), at(v))),
        );
        all.extend(pattern.seams.iter().map(|s| (Node::Seam(s.id), at(s))));
        for sheet in &pattern.sheets {
            let laid = |p: &Arc<Point>| match p.rule {
                PointRule::Mark { .. } => stage_of(sheet),
                _ => 0,
            };
            let points = sheet.points.iter();
            all.extend(points.map(|p| (Node::Point(p.id), at(p).wrapping_add(laid(p)))));
            all.extend(sheet.curves.iter().map(|c| (Node::Curve(c.id), at(c))));
        }
        for panel in &pattern.panels {
            all.extend(panel.edges().map(|e| (Node::Edge(e.id), at(panel))));
            let after = panel.operations.iter().map(|o| Some(o.id));
            let stages = std::iter::once(None).chain(after);
            all.extend(stages.map(|after| (Node::Stage(panel.id, after), at(panel))));
            for step in &panel.operations {
                let sheet = step.kind.sheet().and_then(|id| pattern.sheet(id));
                let laid = sheet.map_or(0, |sheet| stage_of(sheet));
                let node = Node::Stage(panel.id, Some(step.id));
                all.insert((node, at(panel).wrapping_add(laid)));
            }
        }
        all
    }
    let [before, now] = [before, now].map(defined);
    let differ = before.symmetric_difference(&now);
    differ.map(|(node, _)| *node).collect()
}

/// Every part with what it is called, in order; of an edge its corners too.
fn called(pattern: &Pattern) -> Vec<(PartId, String)> {
    let mut all: Vec<(PartId, String)> = Vec::new();
    let mut put = |id: PartId, name: &str| all.push((id, name.to_owned()));
    let p = pattern;
    p.sizes.iter().for_each(|s| put(s.id.into(), &s.name));
    p.fabrics.iter().for_each(|f| put(f.id.into(), &f.name));
    p.variables.iter().for_each(|v| put(v.id.into(), &v.name));
    p.seams.iter().for_each(|s| put(s.id.into(), &s.name));
    for sheet in &p.sheets {
        put(sheet.id.into(), &sheet.name);
        sheet.points.iter().for_each(|x| put(x.id.into(), &x.name));
        sheet.curves.iter().for_each(|x| put(x.id.into(), &x.name));
    }
    for panel in &p.panels {
        put(panel.id.into(), &panel.name);
        panel.lines.iter().for_each(|x| put(x.id.into(), &x.name));
        for edge in panel.edges() {
            put(edge.id.into(), &format!("{} {:?}", edge.name, edge.ends));
        }
        panel.notches.iter().for_each(|x| put(x.id.into(), &x.name));
        let operations = panel.operations.iter();
        operations.for_each(|x| put(x.id.into(), &x.name));
    }
    all
}

/// Nodes that name a panel: they may wait for a line or corner of it that is not there, and need
/// nothing of it meanwhile.
fn users(pattern: &Pattern, panel: PanelId) -> Vec<Node> {
    let mut nodes = Vec::new();
    for place in pattern.users(panel.into()) {
        match place {
            Place::Variable(id) => nodes.push(Node::Variable(id)),
            Place::Point(id) => nodes.push(Node::Point(id)),
            Place::Curve(id) => nodes.push(Node::Curve(id)),
            Place::Seam(id) => nodes.push(Node::Seam(id)),
            Place::Panel(id) => nodes.push(Node::Stage(id, None)),
            _ => {}
        }
    }
    nodes
}

/// Asserts that no more was computed than what depends on definitions that changed. Where parts
/// came, went or changed places, measurements changed or definitions lead in a circle, words and
/// what has a fault are looked at too; that is left out. Whether it was looked into.
fn visits_dependants_alone(before: &Evaluation, after: &Evaluation, update: Update) -> bool {
    let circular = |evaluation: &Evaluation| {
        let found = evaluation.diagnostics();
        found.iter().any(|one| one.code == Code::Cycle)
    };
    let [old, new] = [before, after].map(Evaluation::pattern);
    if before.names() != after.names()
        || called(old) != called(new)
        || old.base_measurements() != new.base_measurements()
        || before.wearer() != after.wearer()
    {
        return false;
    }
    if circular(before) || circular(after) {
        return false;
    }
    let mut allowed = HashSet::new();
    for evaluation in [before, after] {
        let mut found = HashSet::new();
        for node in differing(old, new) {
            evaluation.gather_dependants(node, &mut found);
            if let Node::Stage(panel, None) = node {
                for user in users(evaluation.pattern(), panel) {
                    evaluation.gather_dependants(user, &mut found);
                }
            }
        }
        allowed.extend(found);
    }
    // What is met for the first time depends on nothing that was there.
    let most = allowed.len() + update.met;
    assert!(
        update.computed <= most,
        "{} computed of {most} dependants of {:?}",
        update.computed,
        differing(old, new),
    );
    true
}

#[test]
fn random_edits_of_the_shipped_patterns_evaluate_as_if_afresh() {
    let patterns = PATTERNS.map(|text| toile_interchange::read_pattern(text).unwrap().0);
    let (mut edits, mut bounded) = (0, 0);
    for run in 0..RUNS {
        let mut random = Random(run);
        let mut pattern = patterns[run as usize % 4].clone();
        let size = random.below(pattern.sizes.len());
        let mut evaluation = Evaluation::new(&pattern, &pattern.sizes[size]);
        let mut past: Vec<Pattern> = Vec::new();
        let mut done = 0;
        while done < EDITS {
            let next = match random.below(8) {
                // Undoing is going back to what was before.
                0 => past.pop(),
                k => {
                    let planned = match k {
                        1..4 => Ok(raw(&pattern, &mut random)),
                        _ => wished(&evaluation, &random.wish()),
                    };
                    let mut next = pattern.clone();
                    let taken = planned.is_ok_and(|e| !e.is_empty() && next.apply(&e).is_ok());
                    taken.then(|| {
                        past.push(pattern.clone());
                        next
                    })
                }
            };
            let Some(next) = next else { continue };
            let before = evaluation.clone();
            let update = evaluation.update(&next, before.wearer());
            bounded += usize::from(visits_dependants_alone(&before, &evaluation, update));
            equals_fresh(&evaluation, &format!("run {run}, edit {done}"));
            pattern = next;
            done += 1;
            edits += 1;
        }
        // Back to the beginning in one step.
        evaluation.update(&patterns[run as usize % 4], evaluation.wearer().clone());
        equals_fresh(&evaluation, &format!("run {run}, undone"));
    }
    assert_eq!(edits, RUNS as usize * EDITS);
    assert!(bounded > edits / 4, "{bounded} of {edits} were bounded");
}
