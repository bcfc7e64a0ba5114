//! Every operation on every shipped panel, in every size: what is asked for is what is made, and
//! all else is as it was.

use std::collections::BTreeMap;
use toile_interchange::{read_pattern, write_pattern};
use toile_pattern::*;

const PAIRS: &str = include_str!("../operation_table/pairs.txt");
const EXACT: f64 = 1e-9;

/// A row of the table.
struct Row {
    text: &'static str,
    pattern: &'static str,
    panel: &'static str,
    operation: &'static str,
    words: Vec<&'static str>,
}

impl Row {
    fn all() -> Vec<Self> {
        let rows = PAIRS.lines().filter(|line| !line.starts_with('#'));
        rows.map(|text| {
            let cells: Vec<&str> = text.split(" | ").collect();
            Self {
                text,
                pattern: cells[0],
                panel: cells[1],
                operation: cells[2],
                words: cells[3].split(' ').collect(),
            }
        })
        .collect()
    }

    fn number(&self, k: usize) -> f64 {
        self.words[k].parse().unwrap()
    }

    fn metres(&self, k: usize) -> f64 {
        self.number(k) / 1000.0
    }
}

/// A shipped pattern with the operation of a row put on a panel of it.
struct Made {
    pattern: Pattern,
    panel: Panel,
    operation: OperationId,
    /// The dart a pivot turns.
    dart: Option<OperationId>,
    sides: Vec<PanelId>,
}

fn shipped(name: &str) -> Pattern {
    let folder = env!("CARGO_MANIFEST_DIR");
    let path = format!("{folder}/../../patterns/{name}.toile.json");
    read_pattern(&std::fs::read_to_string(path).unwrap())
        .unwrap()
        .0
}

fn evaluated(pattern: &Pattern) -> Evaluation {
    Evaluation::new(pattern, pattern.base_measurements().unwrap())
}

impl Made {
    fn of(row: &Row) -> Self {
        let pattern = shipped(row.pattern);
        let panel = (**pattern.panel_named(row.panel).unwrap()).clone();
        let operation = OperationId(u32::MAX);
        let (dart, sides) = (None, Vec::new());
        let mut made = Self {
            pattern,
            panel,
            operation,
            dart,
            sides,
        };
        match row.operation {
            "dart" => made.operation = made.dart(row),
            "pivot" => {
                let dart = made.dart(row);
                let mouth = made.mark(row.words[4], row.number(5));
                let wish = plan::PivotWish {
                    dart,
                    mouth: (made.line(), mouth),
                    share: row.number(6).into(),
                    back: row.metres(7).into(),
                    turned: None,
                };
                made.dart = Some(dart);
                made.operation = made.plan(row, |e, p| plan::pivot_dart(e, p, wish));
            }
            "spread" => {
                let edges = [0, 1].map(|k| made.panel.edge_named(row.words[k]).unwrap().id);
                let count: u16 = row.words[2].parse().unwrap();
                let openings = [row.metres(3), row.metres(4)].map(Number::from);
                made.operation = made.plan(row, |e, p| {
                    let (line, cuts) = plan::even_cuts(e, p, edges, count)?;
                    let cuts = cuts
                        .into_iter()
                        .map(|cut| (cut, openings.clone()))
                        .collect();
                    let (held, bridge) = (None, Bridge::Straight);
                    plan::spread_panel(
                        e,
                        p,
                        plan::SpreadWish {
                            line,
                            cuts,
                            held,
                            bridge,
                        },
                    )
                });
            }
            "split" => {
                let ends = [0, 2].map(|k| made.point(row.words[k], row.number(k + 1)));
                let sheet = made.panel.sheet().unwrap();
                let shape = plan::CurveShape::Rule(CurveRule::Line);
                let curve = made.plan(row, |e, _| plan::add_curve(e, (sheet, None), ends, shape));
                let line = made.line();
                let joined = plan::Joined::Sewn;
                let wish = plan::SplitWish {
                    line,
                    curve,
                    joined,
                };
                let found = made.plan(row, |e, p| plan::split_panel(e, p, wish));
                made.operation = found.operation;
                made.sides = found.sides.to_vec();
            }
            "diamond" => {
                let across = [0, 1].map(|k| made.point(row.words[k], 0.5));
                let sheet = made.panel.sheet().unwrap();
                let ends = [2, 3].map(|k| {
                    let rule = PointRule::Between {
                        base: across[0],
                        tip: across[1],
                        along: row.number(k).into(),
                        aside: 0.0.into(),
                    };
                    made.plan(row, |e, _| plan::add_point(e, sheet, None, rule))
                });
                let kind = OperationKind::Diamond {
                    ends,
                    widest: 0.4.into(),
                    intake: row.metres(4).into(),
                };
                made.operation = made.plan(row, |e, p| plan::add_operation(e, p, kind));
            }
            "pleat" => {
                let edges = [0, 1].map(|k| made.panel.edge_named(row.words[k]).unwrap().id);
                let count: u16 = row.words[2].parse().unwrap();
                let (kind, pressed) = match row.words[4] {
                    "left" => (PleatKind::Knife, Side::Left),
                    "right" => (PleatKind::Knife, Side::Right),
                    "box" => (PleatKind::Box, Side::Left),
                    other => panic!("{other}"),
                };
                made.operation = made.plan(row, |e, p| {
                    let (line, lines) = plan::even_cuts(e, p, edges, count)?;
                    let wish = plan::PleatWish {
                        line,
                        lines,
                        depth: row.metres(3).into(),
                        kind,
                        pressed,
                        held: None,
                    };
                    plan::pleat_panel(e, p, wish)
                });
            }
            "insert" => made.operation = made.insert(row),
            "fold" => made.fold(row),
            other => panic!("{other}"),
        }
        made
    }

    fn line(&self) -> LineName {
        Name::Drawn(self.panel.outline().unwrap().id)
    }

    fn mark(&self, edge: &str, share: f64) -> Mark {
        Mark::between(self.panel.edge_named(edge).unwrap().ends, share)
    }

    fn plan<T>(
        &mut self,
        row: &Row,
        plan: impl FnOnce(&Evaluation, PanelId) -> Result<(Vec<Edit>, T), EditError>,
    ) -> T {
        let planned = plan(&evaluated(&self.pattern), self.panel.id);
        let (edits, found) = planned.unwrap_or_else(|error| panic!("{}: {error}", row.text));
        self.pattern.apply(&edits).unwrap();
        self.panel = (**self.pattern.panel(self.panel.id).unwrap()).clone();
        found
    }

    fn dart(&mut self, row: &Row) -> OperationId {
        let kind = OperationKind::Dart {
            line: self.line(),
            mouth: self.mark(row.words[0], row.number(1)),
            intake: row.metres(2).into(),
            apex: Apex::Depth(row.metres(3).into()),
            trued: false,
            keeps_length: false,
            pressed: Pressed::default(),
        };
        self.plan(row, |e, p| plan::add_operation(e, p, kind))
    }

    /// A point on an edge.
    fn point(&mut self, edge: &str, share: f64) -> PointId {
        let id = self.panel.edge_named(edge).unwrap().id;
        let path = evaluated(&self.pattern).edge(id).unwrap().clone();
        let at = path.point(path.at_length(path.length() * share).unwrap());
        let owner = self.panel.edge(id).unwrap().clone();
        let sheet = self.panel.sheet().unwrap();
        let curve = evaluated(&self.pattern).curve(owner.curve).unwrap().clone();
        let share = curve.nearest(at).unwrap().along / curve.length();
        let rule = PointRule::OnCurve {
            curve: owner.curve,
            share: share.into(),
        };
        let planned = plan::add_point(&evaluated(&self.pattern), sheet, None, rule).unwrap();
        self.pattern.apply(&planned.0).unwrap();
        planned.1
    }

    /// A line from a place of the finished panel to another, drawn on it.
    fn insert(&mut self, row: &Row) -> OperationId {
        let sheet = self.plan(row, plan::open_sheet);
        let ends = [0, 2].map(|k| {
            let line = self.line();
            let at = self.mark(row.words[k], row.number(k + 1));
            let rule = PointRule::Mark { line, at };
            self.plan(row, |e, _| plan::add_point(e, sheet, None, rule))
        });
        let shape = plan::CurveShape::Rule(CurveRule::Line);
        let curve = self.plan(row, |e, _| plan::add_curve(e, (sheet, None), ends, shape));
        let kind = (LineKind::Internal, None);
        let chain = plan::Chain::Curves(&[curve]);
        self.plan(row, |e, p| plan::add_line(e, p, kind, chain));
        let mut steps = self.panel.operations.iter();
        steps
            .find(|step| step.kind.sheet() == Some(sheet))
            .unwrap()
            .id
    }

    /// The panel's own fold is put on it anew, else another one.
    fn fold(&mut self, row: &Row) {
        let is_fold = |o: &&std::sync::Arc<Operation>| matches!(o.kind, OperationKind::Fold { .. });
        if let Some(own) = self.panel.operations.iter().find(is_fold).map(|o| o.id) {
            let place = (self.panel.id, own);
            self.plan(row, |e, _| Ok((plan::remove_operation(e, place)?, ())));
        }
        let edge = self.panel.edge_named(row.words[0]).unwrap();
        let ends = edge.ends.map(Mark::corner);
        let kind = OperationKind::Fold {
            line: self.line(),
            ends,
        };
        self.operation = self.plan(row, |e, p| plan::add_operation(e, p, kind));
    }

    /// The stages before and after the operation.
    fn stages<'e>(&self, evaluation: &'e Evaluation) -> [&'e Stage; 2] {
        let step = self.panel.step_of(self.operation).unwrap();
        let before = step.checked_sub(2).map(|k| self.panel.operations[k].id);
        [before, Some(self.operation)]
            .map(|after| &**evaluation.stage(self.panel.id, after).unwrap())
    }
}

/// Length of every named edge of a half (m).
fn lengths<'s>(stages: impl IntoIterator<Item = &'s Stage>, half: u8) -> BTreeMap<EdgeName, f64> {
    let mut found = BTreeMap::new();
    let lines = stages.into_iter().flat_map(|stage| &stage.lines);
    for edge in lines
        .flat_map(|line| &line.edges)
        .filter(|e| e.half == half)
    {
        *found.entry(edge.name).or_insert(0.0) += edge.curve.length();
    }
    found
}

fn made_edge(by: OperationId, role: Role, index: u16) -> EdgeName {
    Name::Made { by, role, index }
}

fn found(stage: &Stage, by: OperationId) -> StageDart {
    *stage.darts.iter().find(|dart| dart.by == by).unwrap()
}

fn angle(dart: &StageDart) -> f64 {
    let [a, b] = dart.mouth.map(|end| end - dart.pivot);
    a.perp(&b).atan2(a.dot(&b)).abs()
}

/// What an operation makes is as asked; gives by how much edges that were there are shorter.
fn check_made(row: &Row, made: &Made, [before, after]: [&Stage; 2]) -> BTreeMap<EdgeName, f64> {
    let now = lengths([after], 0);
    let leg = |by: OperationId, index: u16| now[&made_edge(by, Role::Leg, index)];
    let near = |a: f64, b: f64| assert!((a - b).abs() < EXACT, "{}: {a} for {b}", row.text);
    let mut shorter = BTreeMap::new();
    match row.operation {
        "dart" => {
            let dart = found(after, made.operation);
            let half = 0.5 * (dart.mouth[1] - dart.mouth[0]).norm();
            near(leg(made.operation, 0), row.metres(3).hypot(half));
            near(leg(made.operation, 0), leg(made.operation, 1));
            let edge = made.panel.edge_named(row.words[0]).unwrap();
            shorter.insert(Name::Drawn(edge.id), row.metres(2));
        }
        "pivot" => {
            let dart = made.dart.unwrap();
            let (whole, new) = (found(before, dart), found(after, made.operation));
            let share = row.number(6);
            near(angle(&new), share * angle(&whole));
            near(leg(made.operation, 0), leg(made.operation, 1));
            if share < 1.0 {
                let old = found(after, dart);
                near(angle(&old) + angle(&new), angle(&whole));
                near(leg(dart, 0), leg(dart, 1));
            }
            for index in [0, 1] {
                let name = made_edge(dart, Role::Leg, index);
                let left = now.get(&name).copied().unwrap_or(0.0);
                shorter.insert(name, lengths([before], 0)[&name] - left);
            }
        }
        "spread" => {
            let count: u16 = row.words[2].parse().unwrap();
            for cut in 0..count {
                for end in [0, 1] {
                    let name = made_edge(made.operation, Role::Opening, 2 * cut + end);
                    let opening = now.get(&name).copied().unwrap_or(0.0);
                    near(opening, row.metres(3 + usize::from(end)));
                }
            }
        }
        "pleat" => {
            // Both layers of every fold are equally long, so the pleat closes.
            let count: u16 = row.words[2].parse().unwrap();
            let folds = if row.words[4] == "box" { 2 } else { 1 };
            for (pleat, end) in (0..count).flat_map(|n| [(n, 0), (n, 4)]) {
                for fold in 0..folds {
                    let layer = |k: u16| {
                        now[&made_edge(made.operation, Role::Underlay, 8 * pleat + end + k)]
                    };
                    near(layer(2 * fold), layer(2 * fold + 1));
                    assert!(layer(2 * fold) > row.metres(3) - EXACT, "{}", row.text);
                }
            }
        }
        "insert" => {
            let edge = |k: usize| {
                let id = Name::Drawn(made.panel.edge_named(row.words[k]).unwrap().id);
                let own = after.outline().iter().filter(|edge| edge.name == id);
                let curves = own.map(|edge| edge.curve).collect();
                let path = toile_geometry::Path::new(curves);
                path.point(path.at_length(path.length() * row.number(k + 1)).unwrap())
            };
            let line = made.panel.lines.last().unwrap();
            assert_eq!(line.by, Some(made.operation), "{}", row.text);
            let length = now[&Name::Drawn(line.edges[0].id)];
            near(length, (edge(2) - edge(0)).norm());
        }
        "diamond" => {
            let width = found(after, made.operation).mouth;
            near((width[1] - width[0]).norm(), row.metres(4));
            near(leg(made.operation, 0), leg(made.operation, 3));
            near(leg(made.operation, 1), leg(made.operation, 2));
        }
        "fold" => {
            let edge = made.panel.edge_named(row.words[0]).unwrap();
            let name = Name::Drawn(edge.id);
            shorter.insert(name, lengths([before], 0)[&name]);
            for (name, other) in lengths([after], 1) {
                near(other, now[&name]);
            }
        }
        _ => {}
    }
    shorter
}

fn check(row: &Row) {
    let made = Made::of(row);
    let written = write_pattern(&made.pattern).unwrap();
    let (again, notes) = read_pattern(&written).unwrap();
    assert!(
        notes.is_empty() && again.says_the_same(&made.pattern),
        "{}",
        row.text
    );
    for size in &made.pattern.sizes {
        let wearer = Wearer {
            measurements: size.measurements.clone(),
            size: Some(size.id),
        };
        let evaluation = Evaluation::new(&made.pattern, wearer);
        let findings = evaluation.draft().1;
        assert!(
            findings.is_empty(),
            "{}, {}: {findings:?}",
            row.text,
            size.name
        );
        let [before, after] = made.stages(&evaluation);
        let shorter = check_made(row, &made, [before, after]);
        let now = match made.sides[..] {
            [left, right] => {
                let sides = [left, right].map(|id| &**evaluation.stage(id, None).unwrap());
                let now = lengths(sides, 0);
                let cut = [0, 1].map(|k| now[&made_edge(made.operation, Role::Split, k)]);
                assert!((cut[0] - cut[1]).abs() < EXACT, "{}: {cut:?}", row.text);
                now
            }
            _ => lengths([after], 0),
        };
        for (name, length) in lengths([before], 0) {
            let left = now.get(&name).copied().unwrap_or(0.0);
            let taken = shorter.get(&name).copied().unwrap_or(0.0);
            let wrong = left + taken - length;
            assert!(
                wrong.abs() < EXACT,
                "{}, {}, {name:?}: {wrong}",
                row.text,
                size.name
            );
        }
    }
}

#[test]
fn every_operation_does_on_every_shipped_panel_what_is_asked() {
    let rows = Row::all();
    assert!(rows.len() >= 60, "{}", rows.len());
    for row in &rows {
        check(row);
    }
}

/// The garment of a draft sewn together, flat.
fn sewn(draft: &Draft) -> toile_assembly::Sanity {
    let meshes = toile_assembly::mesh_pieces(draft, 0.02).unwrap();
    let mut garment = toile_assembly::Garment {
        stitches: meshes.stitches,
        ..Default::default()
    };
    for mesh in &meshes.pieces {
        let base = garment.flat.len() as u32;
        garment.flat.extend(&mesh.points);
        let triangles = mesh.triangles.iter();
        let own = triangles.map(|t| t.map(|v| v + base));
        garment.triangles.extend(own);
    }
    toile_assembly::sanity(draft, &garment)
}

#[test]
fn pleated_panels_are_sewn_as_their_patterns_are() {
    // Folds deeper than the edges of the mesh: narrower ones would fall together in it.
    for words in [
        "hem waist 2 40 left",
        "hem waist 1 40 right",
        "hem waist 2 30 box",
    ] {
        let row = Row {
            text: words,
            pattern: "gathered-skirt",
            panel: "front",
            operation: "pleat",
            words: words.split(' ').collect(),
        };
        let before = sewn(&evaluated(&shipped(row.pattern)).draft().0);
        let made = Made::of(&row);
        let evaluation = evaluated(&made.pattern);
        let errors = evaluation.check().into_iter();
        let errors: Vec<_> = errors.filter(|d| d.severity == Severity::Error).collect();
        assert!(errors.is_empty(), "{}: {errors:?}", row.text);
        let report = sewn(&evaluation.draft().0);
        let same = report.is_sound() && report.components == before.components;
        assert!(same, "{}: {report:?}", row.text);
    }
}
