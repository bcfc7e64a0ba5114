//! Any run of planners, whatever it is asked: what succeeds is taken by the document and keeps
//! ids and names unique, what is refused says why, nothing panics.

use super::*;
use crate::sample::{self, dart, fold, formula, formula_in, outline, sample};
use proptest::prelude::*;
use toile_pattern::plan::*;

/// One wish: which planner, which parts, where.
pub type Wish = (u8, [u16; 4], [f64; 3]);

/// The part of that number among those of a kind; sometimes one that is not there.
struct Chooser<'p> {
    pattern: &'p Pattern,
    parts: Vec<PartId>,
    numbers: [u16; 4],
}

impl Chooser<'_> {
    fn pick<T: From<u32>>(&self, k: usize, is: impl Fn(&PartId) -> bool) -> T {
        let all: Vec<&PartId> = self.parts.iter().filter(|part| is(part)).collect();
        let number = usize::from(self.numbers[k]);
        let is_there = number % 13 > 0 && !all.is_empty();
        match is_there.then(|| all[number % all.len()]) {
            Some(part) => T::from(part.number()),
            None => T::from(self.pattern.ids.next + 3),
        }
    }

    /// A point, mostly of the chosen sheet.
    fn point(&self, k: usize) -> PointId {
        let sheet = self.pattern.sheet(self.sheet());
        self.pick(k, |part| match part {
            PartId::Point(id) => sheet.is_none_or(|sheet| sheet.point(*id).is_some()),
            _ => false,
        })
    }

    /// A curve, mostly of the chosen sheet.
    fn curve(&self, k: usize) -> CurveId {
        let sheet = self.pattern.sheet(self.sheet());
        self.pick(k, |part| match part {
            PartId::Curve(id) => sheet.is_none_or(|sheet| sheet.curve(*id).is_some()),
            _ => false,
        })
    }

    /// The sheet that is drawn on.
    fn sheet(&self) -> SheetId {
        self.pick(3, |part| matches!(part, PartId::Sheet(_)))
    }

    fn panel(&self, k: usize) -> PanelId {
        self.pick(k, |part| matches!(part, PartId::Panel(_)))
    }

    fn edge(&self, k: usize) -> EdgeId {
        self.pick(k, |part| matches!(part, PartId::Edge(_)))
    }

    fn any(&self, k: usize) -> PartId {
        self.parts[usize::from(self.numbers[k]) % self.parts.len()]
    }

    /// An operation and its panel.
    fn operation(&self) -> (PanelId, OperationId) {
        let id: OperationId = self.pick(0, |part| matches!(part, PartId::Operation(_)));
        let mut panels = self.pattern.panels.iter();
        let owner = panels.find(|panel| panel.operations.iter().any(|known| known.id == id));
        (owner.map_or(self.panel(1), |panel| panel.id), id)
    }

    /// The line, and two of its corners, of the panel an edge is on.
    fn line(&self, k: usize) -> (PanelId, LineId, [PointId; 2]) {
        let edge = self.edge(k);
        let panels = self.pattern.panels.iter();
        let found = panels.into_iter().find_map(|panel| {
            let line = panel.line_of(edge)?;
            Some((panel.id, line.id, panel.edge(edge)?.ends))
        });
        found.unwrap_or((self.panel(k), LineId(9999), [self.point(0), self.point(1)]))
    }
}

/// The edits a wish comes to.
pub fn wished(evaluation: &Evaluation, wish: &Wish) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let (which, numbers, [x, y, z]) = wish;
    let parts: Vec<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
    if parts.is_empty() {
        return add_sheet(evaluation, None, [*x, *y]).map(|done| done.0);
    }
    let c = Chooser {
        pattern,
        parts,
        numbers: *numbers,
    };
    let at = v(*x, *y);
    let n = numbers[3] / 7;
    let (panel, line, ends) = c.line(2);
    let share = Mark::between(ends, *z);
    let rules = [
        PointRule::at(*x, *y),
        PointRule::Offset {
            base: c.point(0),
            x: formula("bust / 10"),
            y: (*y).into(),
        },
        PointRule::OnCurve {
            curve: c.curve(0),
            share: (*z).into(),
        },
        PointRule::Mirrored {
            base: c.point(0),
            line: [c.point(1), c.point(2)],
        },
        PointRule::CurveCrossing {
            curves: [c.curve(0), c.curve(1)],
            index: 0,
        },
    ];
    let dart = |apex| OperationKind::Dart {
        line: Name::Drawn(line),
        mouth: share.clone(),
        intake: (z * 0.05).into(),
        apex,
        trued: false,
        keeps_length: false,
        pressed: toile_pattern::Pressed::default(),
    };
    match which % 48 {
        0 => add_sheet(evaluation, None, [*x, *y]).map(|done| done.0),
        1 | 2 => {
            let rule = rules[usize::from(n) % rules.len()].clone();
            add_point(evaluation, c.sheet(), None, rule).map(|done| done.0)
        }
        3 | 4 => {
            let shapes = [
                CurveShape::Rule(CurveRule::Line),
                CurveShape::ArcThrough(at),
                CurveShape::Spline {
                    handles: [at, v(*y, *z)],
                    knots: vec![],
                },
                CurveShape::Rule(CurveRule::Copy { of: c.curve(2) }),
            ];
            let shape = shapes[usize::from(n) % shapes.len()].clone();
            let ends = [c.point(0), c.point(1)];
            add_curve(evaluation, (c.sheet(), None), ends, shape).map(|done| done.0)
        }
        5 => {
            let wish = (
                FirstCorner::At([(*x).into(), (*y).into()]),
                [formula("bust / 4"), (*z).into()],
            );
            let new = (n % 2 == 0).then(NewPanel::default);
            add_rectangle(evaluation, c.sheet(), wish, new).map(|done| done.0)
        }
        6 => {
            let places = [at, v(*y, *z), v(*z, *x), v(0.1, 0.9)];
            let new = (n % 2 == 0).then(NewPanel::default);
            add_polygon(evaluation, c.sheet(), &places, new).map(|done| done.0)
        }
        7 => {
            let points = [c.point(0), c.point(1), c.point(2)];
            let chain = Chain::Points(&points);
            trace_panel(evaluation, c.sheet(), chain, NewPanel::default()).map(|done| done.0)
        }
        8 | 9 => {
            let holes = if n % 2 == 0 {
                Holes::Cut
            } else {
                Holes::Ignored
            };
            let wish = (at, holes);
            trace_face(evaluation, c.sheet(), wish, NewPanel::default()).map(|done| done.0)
        }
        10 => {
            let curves = [c.curve(0)];
            let kind = [LineKind::Internal, LineKind::Hole][usize::from(n % 2)];
            let chain = Chain::Curves(&curves);
            add_line(evaluation, panel, (kind, None), chain).map(|done| done.0)
        }
        11 => remove_line(evaluation, (panel, line)),
        12 | 13 => {
            let points = [c.point(0), c.point(1), c.point(2)];
            let maps = [
                Affine::translation(at),
                Affine::rotation(at, *z),
                Affine::scaling(at, [*z, 1.0]),
                Affine::reflection([at, v(*z, *z)]),
            ];
            let map = maps[usize::from(n) % maps.len()];
            transform_points(evaluation, &points, &map).map(|moved| moved.edits)
        }
        14 => move_point(evaluation, c.point(0), at),
        15 => {
            let groups = [vec![c.point(0)], vec![c.point(1), c.point(2)]];
            align(evaluation, &groups, Alignment::Left).map(|moved| moved.edits)
        }
        16 => {
            let groups = [vec![c.point(0)], vec![c.point(1)], vec![c.point(2)]];
            distribute(evaluation, &groups, Axis::Y).map(|moved| moved.edits)
        }
        17 => add_operation(evaluation, panel, dart(Apex::Depth(0.05.into()))).map(|d| d.0),
        18 => {
            let kinds = [
                OperationKind::Fold {
                    line: Name::Drawn(line),
                    ends: ends.map(Mark::corner),
                },
                OperationKind::Diamond {
                    ends: [c.point(0), c.point(1)],
                    widest: (*z).into(),
                    intake: 0.01.into(),
                },
                dart(Apex::Point(c.point(0))),
            ];
            let kind = kinds[usize::from(n) % kinds.len()].clone();
            add_operation(evaluation, panel, kind).map(|done| done.0)
        }
        19 => set_operation(evaluation, c.operation(), dart(Apex::Depth((*x).into()))),
        20 => move_operation(evaluation, c.operation(), usize::from(n % 4)),
        21 => {
            let wish = (line, share);
            add_notch(evaluation, panel, wish, NotchKind::Slit).map(|done| done.0)
        }
        22 => {
            let row = NotchRow {
                line,
                ends: ends.map(Name::Drawn),
                count: u32::from(n % 5),
            };
            add_notches(evaluation, panel, row, NotchKind::V).map(|done| done.0)
        }
        23 => {
            let id: NotchId = c.pick(0, |part| matches!(part, PartId::Notch(_)));
            let has = |panel: &&std::sync::Arc<Panel>| panel.notches.iter().any(|n| n.id == id);
            let owner = pattern.panels.iter().find(has);
            remove_notch(evaluation, (owner.map_or(panel, |p| p.id), id))
        }
        24 | 25 => remove_parts(evaluation, &[c.any(0), c.any(1)][..usize::from(1 + n % 2)]),
        26 => {
            let names = ["x", "front", "it's", "A", "bust"];
            rename(evaluation, c.any(0), names[usize::from(n) % names.len()])
        }
        27 | 28 => {
            let entries = numbers_of(evaluation, c.any(0));
            let Some(entry) = entries.get(usize::from(n) % entries.len().max(1)) else {
                return Ok(Vec::new());
            };
            let texts = [
                "bust / 8",
                "12",
                "0.3",
                "45deg",
                "length(front.right)",
                "bus",
            ];
            let text = texts[usize::from(numbers[1]) % texts.len()];
            let number = read_number(evaluation, text, entry.want)?;
            assert!(!number_text(evaluation, &number, entry.want).is_empty());
            let size = c.pick(2, |part| matches!(part, PartId::Size(_)));
            match n % 4 {
                0 => adjust_number(evaluation, &entry.place, *z),
                1 => set_number_in_size(evaluation, &entry.place, (size, Some(*z))),
                2 => clear_number(evaluation, &entry.place),
                _ => set_number(evaluation, &entry.place, number),
            }
        }
        29 => {
            let fragment = copy(evaluation, &[c.any(0), c.any(1)])?;
            let target = PasteTarget {
                sheet: (n % 2 == 0).then(|| c.sheet()),
                offset: [*x, *y],
            };
            paste(evaluation, &fragment, target).map(|pasted| pasted.edits)
        }
        30 => duplicate(evaluation, &[c.any(0)]).map(|pasted| pasted.edits),
        31 => add_size(evaluation, None, Measurements::child(6)).map(|done| done.0),
        32 => add_variable(evaluation, None, formula("hip / 4")).map(|done| done.0),
        33 => {
            let sewn = |k: usize| {
                let edge = c.edge(k);
                let panels = &pattern.panels;
                let own = panels.iter().find(|panel| panel.edge(edge).is_some());
                SewnEdge {
                    panel: own.map_or(panel, |panel| panel.id),
                    copy: 0,
                    half: (n % 7 == 0).into(),
                    edge,
                }
            };
            sew(evaluation, [&[sewn(0)], &[sewn(1)]], None).map(|done| done.0)
        }
        34 => {
            let seam = c.pick(0, |part| matches!(part, PartId::Seam(_)));
            flip_side(evaluation, seam, SeamSide::First)
        }
        35 => {
            let curves = [c.curve(0), c.curve(1)];
            mark_crossings(evaluation, c.sheet(), curves).map(|done| done.0)
        }
        46 => {
            let (line, lines) = even_cuts(evaluation, panel, [c.edge(2), c.edge(0)], n % 3 + 1)?;
            let kinds = [PleatKind::Knife, PleatKind::Box, PleatKind::Inverted];
            let sides = [Side::Left, Side::Right];
            let wish = PleatWish {
                line,
                lines,
                depth: (z * 0.05).into(),
                kind: kinds[usize::from(n) % 3],
                pressed: sides[usize::from(n) % 2],
                held: None,
            };
            pleat_panel(evaluation, panel, wish).map(|done| done.0)
        }
        41 => open_sheet(evaluation, panel).map(|done| done.0),
        42 | 43 => {
            let (mut edits, sheet) = open_sheet(evaluation, panel)?;
            let more = drawn_on(
                &done(pattern, &edits),
                (panel, sheet),
                (Name::Drawn(line), &share),
            )?;
            edits.extend(more);
            Ok(edits)
        }
        44 => {
            let sheet = c.sheet();
            let (Some(found), Some(owner)) = (pattern.sheet(sheet), pattern.panel(panel)) else {
                return Ok(Vec::new());
            };
            let last = owner.operations.last().map(|step| step.id);
            let on = (n % 3 > 0).then_some((panel, last.filter(|_| n % 3 == 1)));
            Ok(vec![Edit::Put(Entity::Sheet(SheetHead {
                id: sheet,
                name: found.name.clone(),
                on: found.on.and(on),
                on_table: found.on_table,
            }))])
        }
        36 => {
            let (panel, dart) = c.operation();
            let wish = PivotWish {
                dart,
                mouth: (Name::Drawn(line), share),
                share: (*z).into(),
                back: 0.004.into(),
                turned: None,
            };
            pivot_dart(evaluation, panel, wish).map(|done| done.0)
        }
        37 | 38 => {
            let (line, cuts) = even_cuts(evaluation, panel, [c.edge(2), c.edge(0)], n % 3 + 1)?;
            let openings = [0.02, (*z).clamp(0.0, 0.01)].map(Number::from);
            let cuts = cuts.into_iter().map(|cut| (cut, openings.clone()));
            let wish = SpreadWish {
                line,
                cuts: cuts.collect(),
                held: None,
                bridge: Bridge::Smooth,
            };
            spread_panel(evaluation, panel, wish).map(|done| done.0)
        }
        39 | 40 => {
            let panel = c.panel(1);
            let owner = pattern
                .panel(panel)
                .and_then(|panel| pattern.lineage(panel).last().copied());
            let line = owner
                .and_then(|owner| owner.outline())
                .map_or(line, |line| line.id);
            let wish = SplitWish {
                line: Name::Drawn(line),
                curve: c.curve(0),
                joined: Joined::Sewn,
            };
            split_panel(evaluation, panel, wish).map(|done| done.0)
        }
        _ => {
            let near = nearest_mark(evaluation, panel, at)?;
            match near.edge {
                Name::Drawn(edge) if n % 2 == 0 => {
                    divide_edge(evaluation, (panel, edge), Some(at)).map(|done| done.0)
                }
                _ => join_edges(evaluation, (panel, ends[1])),
            }
        }
    }
}

/// What draws a line on a sheet that lies on a panel, from one of its points to a mark, and inserts
/// it.
fn drawn_on(
    pattern: &Pattern,
    (panel, sheet): (PanelId, SheetId),
    (line, at): (LineName, &Mark),
) -> Result<Vec<Edit>, EditError> {
    let rule = PointRule::Mark {
        line,
        at: at.clone(),
    };
    let (mut edits, end) = add_point(&evaluated(pattern), sheet, None, rule)?;
    let work = done(pattern, &edits);
    let start = work.sheet(sheet).and_then(|sheet| sheet.points.first());
    let ends = [start.map_or(end, |point| point.id), end];
    let shape = CurveShape::Rule(CurveRule::Line);
    let (more, curve) = add_curve(&evaluated(&work), (sheet, None), ends, shape)?;
    edits.extend(more.clone());
    let work = done(&work, &more);
    let kind = (LineKind::Internal, None);
    let (more, _) = add_line(&evaluated(&work), panel, kind, Chain::Curves(&[curve]))?;
    edits.extend(more);
    Ok(edits)
}

fn start() -> Pattern {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    let front = pattern.panels[0].id;
    for kind in [kind, fold(&pattern, "left")] {
        let (edits, _) = add_operation(&evaluated(&pattern), front, kind).unwrap();
        pattern.apply(&edits).unwrap();
    }
    let mark = Mark::between(sample::ends(&pattern, "front", "right"), 0.5);
    let wish = (outline(&pattern, "front"), mark);
    let (edits, _) = add_notch(&evaluated(&pattern), front, wish, NotchKind::V).unwrap();
    pattern.apply(&edits).unwrap();
    // Curves that panels may be split along.
    for k in 0..2 {
        let sheet = pattern.sheets[k].clone();
        for (from, to) in [("left", "right"), ("bottom", "top")] {
            let ends = [from, to].map(|name| {
                let curve = sheet.curve_named(name).unwrap().id;
                let share = 0.4.into();
                dot(&mut pattern, sheet.id, PointRule::OnCurve { curve, share })
            });
            straight(&mut pattern, sheet.id, ends);
        }
    }
    let number = formula_in(&pattern, "length(back.right) / 10");
    let (edits, _) = add_variable(&evaluated(&pattern), None, number).unwrap();
    pattern.apply(&edits).unwrap();
    pattern
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(96) })]

    #[test]
    fn whatever_is_planned_is_taken(
        wishes in prop::collection::vec(
            (any::<u8>(), any::<[u16; 4]>(), [-0.2..0.8, -0.2..0.8, -0.2..1.2]),
            1..24,
        ),
    ) {
        let mut pattern = start();
        let body = Measurements::adult();
        let mut evaluation = Evaluation::new(&pattern, &body);
        for wish in &wishes {
            match wished(&evaluation, wish) {
                Ok(edits) => {
                    let after = done(&pattern, &edits);
                    pattern = after;
                    evaluation.update(&pattern, &body);
                }
                Err(error) => {
                    let told = error.to_string();
                    prop_assert!(told.contains(": "), "a remedy: {}", told);
                }
            }
            prop_assert_eq!(evaluation.pattern(), &pattern);
        }
        let fresh = Evaluation::new(&pattern, &body);
        prop_assert_eq!(fresh.points(), evaluation.points());
        prop_assert_eq!(fresh.diagnostics(), evaluation.diagnostics());
        for panel in &pattern.panels {
            let [now, anew] = [&evaluation, &fresh].map(|e| e.last_stage(panel));
            prop_assert_eq!(now.is_some(), anew.is_some());
            if let (Some(now), Some(anew)) = (now, anew) {
                prop_assert!(now.is_same(anew), "panel {:?}", panel.name);
            }
        }
    }
}
