//! The scene of a pattern as the canvas draws it. Its parts are cached by the values they were made from:
//! an edit remakes only those whose value changed.

use super::allowance::CutLines;
use super::panel_shape::PanelShape;
use super::seams::{SeamDrawing, draw_seams};
use super::suggested::{Suggested, SuggestedLast};
use super::walked::{WalkedLast, WalkedSeam};
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;
use std::sync::Arc;
use toile_geometry::{Bounds2, Path, Vec2};
use toile_pattern::plan::{self, EdgePart};
use toile_pattern::{
    Curve, CurveId, CurveRule, Draft, Evaluation, Guide, Name, OperationId, OperationKind, Panel,
    PanelId, PointId, PressArrow, SeamId, Sheet, SheetId, Stage, press_arrows,
};

/// Largest distance between a curve and the polyline drawn for it (pixels).
const CURVE_TOLERANCE: f64 = 0.15;

/// Largest distance at which the end of a line counts as lying at a corner (m).
const AT_CORNER: f64 = 1e-6;

/// Everything that the canvas draws of a pattern.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Sheets, in the pattern's order.
    pub sheets: Vec<SheetScene>,
    /// Panels, in the pattern's order, without those that never could be drawn. In place of a panel that is
    /// split, its parts are drawn.
    pub panels: Vec<PanelScene>,
    /// Seams in the pattern's order, numbered from 1.
    pub seams: Vec<SeamDrawing>,
    /// Cut lines.
    pub cut_lines: CutLines,
    /// The guides.
    pub guides: Vec<Arc<Guide>>,
    /// The pieces and seams that the scene was made from.
    pub draft: Arc<Draft>,
    /// Level of detail of curves: exponent of the power of two that is the finest enlargement they are
    /// drawn for (pixels per metre).
    octave: i32,
    lines: HashMap<*const Path, KeptLine>,
    shapes: HashMap<*const Stage, KeptShape>,
    /// Number of lines and shapes made so far, for tests of the cache.
    made: u64,
    /// Cache of the walked seam; clones of the scene share it.
    walked: Rc<WalkedLast>,
    /// Cache of the suggested seams; clones of the scene share it.
    suggested: Rc<SuggestedLast>,
}

/// A polyline, with the path it was made from. The path is kept alive so that its address identifies it.
#[derive(Clone, Debug)]
struct KeptLine {
    _path: Arc<Path>,
    line: Arc<[Vec2]>,
}

#[derive(Clone, Debug)]
struct KeptShape {
    _stage: Arc<Stage>,
    shape: Arc<PanelShape>,
}

/// A sheet as drawn.
#[derive(Clone, Debug)]
pub struct SheetScene {
    /// Identity of the sheet.
    pub id: SheetId,
    /// Name of the sheet.
    pub name: String,
    /// Points that can be drawn.
    pub points: Vec<PointScene>,
    /// Curves that can be drawn.
    pub curves: Vec<CurveScene>,
    /// Whether no panel is traced on the sheet, and the sheet lies on no panel.
    pub is_bare: bool,
    /// The panel that the sheet lies on, for drawing on the finished panel; `None` for a free sheet.
    pub on: Option<PanelId>,
    /// Edges of that panel after its operations, for snapping.
    pub edges: Vec<EdgePart>,
}

/// Role of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointRole {
    /// An end of curves or edges.
    Corner,
    /// A handle, which shapes a curve.
    Handle,
    /// A base for the construction of other points.
    Construction,
}

/// A point as drawn.
#[derive(Clone, Debug)]
pub struct PointScene {
    /// Identity of the point.
    pub id: PointId,
    /// Name of the point.
    pub name: String,
    /// Coordinates on the sheet (m).
    pub at: Vec2,
    /// Role of the point.
    pub role: PointRole,
    /// Whether the point is a corner that operations moved in all of its panels: no outline has a corner
    /// there any more.
    pub is_left: bool,
}

/// A curve as drawn.
#[derive(Clone, Debug)]
pub struct CurveScene {
    /// Identity of the curve.
    pub id: CurveId,
    /// Name of the curve.
    pub name: String,
    /// Polyline on the sheet (m).
    pub line: Arc<[Vec2]>,
    /// Exact path.
    pub path: Arc<Path>,
    /// Whether edges of panels follow the curve.
    pub is_traced: bool,
    /// Pairs of points: an end or an inner knot of the curve, and one of its handles.
    pub handles: Vec<[PointId; 2]>,
}

/// A panel as drawn.
#[derive(Clone, Debug)]
pub struct PanelScene {
    /// Identity of the panel.
    pub id: PanelId,
    /// Sheet on which the panel is traced.
    pub sheet: SheetId,
    /// Name of the panel.
    pub name: String,
    /// Cutting instruction: number of times the panel is cut, in words; empty for once.
    pub cut: String,
    /// The drawn shape.
    pub shape: Arc<PanelShape>,
    /// Drafted corners of the panel: the end points of its edges.
    pub corners: BTreeSet<PointId>,
    /// Corners that the panel's operations moved: the visible outline has no corner at their drafted
    /// places.
    pub left: BTreeSet<PointId>,
    /// The operation that lays the panel on the fold; `None` if the panel is not folded.
    pub fold_step: Option<OperationId>,
    /// Both ends of the fold line; `None` if the panel is not folded.
    pub fold: Option<[Vec2; 2]>,
    /// Arrows for the pressing directions of the panel's darts and pleats.
    pub pressed: Vec<PressArrow>,
    /// Whether the panel cannot be drawn now, so that the last valid shape is shown.
    pub is_stale: bool,
}

impl Scene {
    /// Updates the scene to an evaluated pattern and its draft; curves are fine enough for an enlargement
    /// of two to the power of `octave` (pixels per metre).
    pub fn update(&mut self, evaluation: &Evaluation, draft: &Arc<Draft>, octave: i32) {
        if octave != self.octave {
            self.octave = octave;
            self.lines.clear();
            self.shapes.clear();
        }
        let pattern = evaluation.pattern();
        let traced: BTreeSet<CurveId> = pattern
            .panels
            .iter()
            .flat_map(|panel| panel.edges().map(|edge| edge.curve))
            .collect();
        let (mut lines, mut shapes) = (HashMap::new(), HashMap::new());
        self.sheets = pattern
            .sheets
            .iter()
            .map(|sheet| self.sheet(sheet, evaluation, &traced, &mut lines))
            .collect();
        self.panels = pattern
            .panels
            .iter()
            .filter(|panel| !pattern.is_replaced(panel))
            .filter_map(|panel| self.panel(panel, evaluation, &mut shapes))
            .collect();
        self.guides.clone_from(&pattern.guides);
        self.leave_points();
        // Cached lines and shapes that were not used for this scene are discarded.
        self.lines = lines;
        self.shapes = shapes;
        self.seams = draw_seams(draft, self.tolerance());
        self.made += self.cut_lines.follow(pattern, draft);
        self.draft = draft.clone();
    }

    /// Sets `is_left` of every point: whether all panels that have a corner there moved it away from the
    /// drafted place.
    fn leave_points(&mut self) {
        for sheet in &mut self.sheets {
            for point in &mut sheet.points {
                let of_sheet = self.panels.iter().filter(|panel| panel.sheet == sheet.id);
                let mut own = of_sheet
                    .filter(|panel| panel.corners.contains(&point.id))
                    .peekable();
                point.is_left = own.peek().is_some() && own.all(|p| p.left.contains(&point.id));
            }
        }
    }

    /// Removes all panels except the given ones, and the sheets that these do not need.
    pub fn isolate(&mut self, panels: &[PanelId]) {
        self.panels.retain(|panel| panels.contains(&panel.id));
        let sheets: Vec<SheetId> = self.panels.iter().map(|panel| panel.sheet).collect();
        self.sheets.retain(|sheet| match sheet.on {
            Some(on) => panels.contains(&on),
            None => sheets.contains(&sheet.id),
        });
    }

    /// Whether the scene has nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.panels.is_empty() && self.sheets.iter().all(|sheet| sheet.points.is_empty())
    }

    /// Number of lines, shapes and walked seams made so far; panning makes none.
    pub fn made(&self) -> u64 {
        self.made + self.walked.made()
    }

    /// A seam, measured and flattened for walking; `None` if it cannot be walked.
    pub fn walked(&self, seam: SeamId) -> Option<Arc<WalkedSeam>> {
        self.walked.seam(&self.draft, seam)
    }

    /// Seams suggested for the edges that are not sewn, of the pattern that the scene shows.
    pub fn suggested(&self, evaluation: &Evaluation) -> Arc<Suggested> {
        self.suggested.seams(&self.draft, evaluation)
    }

    /// The level of detail that the scene is drawn for.
    pub fn octave(&self) -> i32 {
        self.octave
    }

    /// The panel with an identity.
    pub fn panel_scene(&self, id: PanelId) -> Option<&PanelScene> {
        self.panels.iter().find(|panel| panel.id == id)
    }

    /// The sheet with an identity.
    pub fn sheet_scene(&self, id: SheetId) -> Option<&SheetScene> {
        self.sheets.iter().find(|sheet| sheet.id == id)
    }

    /// The sheet of a point, and the point.
    pub fn point(&self, id: PointId) -> Option<(&SheetScene, &PointScene)> {
        let mut sheets = self.sheets.iter();
        sheets.find_map(|sheet| {
            let found = sheet.points.iter().find(|point| point.id == id)?;
            Some((sheet, found))
        })
    }

    /// The sheet of a curve, and the curve.
    pub fn curve(&self, id: CurveId) -> Option<(&SheetScene, &CurveScene)> {
        let mut sheets = self.sheets.iter();
        sheets.find_map(|sheet| {
            let found = sheet.curves.iter().find(|curve| curve.id == id)?;
            Some((sheet, found))
        })
    }

    fn tolerance(&self) -> f64 {
        CURVE_TOLERANCE / f64::from(self.octave).exp2()
    }

    fn sheet(
        &mut self,
        sheet: &Sheet,
        evaluation: &Evaluation,
        traced: &BTreeSet<CurveId>,
        lines: &mut HashMap<*const Path, KeptLine>,
    ) -> SheetScene {
        let mut corners = BTreeSet::new();
        let mut shaping = BTreeSet::new();
        for curve in &sheet.curves {
            corners.extend(curve.ends);
            shaping.extend(handles(curve).iter().map(|pair| pair[1]));
        }
        let panels = &evaluation.pattern().panels;
        let own = panels
            .iter()
            .filter(|panel| panel.sheet() == Some(sheet.id));
        corners.extend(own.clone().flat_map(|p| p.edges().flat_map(|e| e.ends)));
        let points = sheet.points.iter().filter_map(|point| {
            Some(PointScene {
                id: point.id,
                name: point.name.clone(),
                at: evaluation.point(point.id)?,
                role: match point.id {
                    id if corners.contains(&id) => PointRole::Corner,
                    id if shaping.contains(&id) => PointRole::Handle,
                    _ => PointRole::Construction,
                },
                is_left: false,
            })
        });
        let is_bare = own.count() == 0 && sheet.on.is_none();
        let laid = sheet.on.and_then(|(id, after)| {
            let panel = evaluation.pattern().panel(id)?;
            Some(plan::edge_parts(
                evaluation,
                panel,
                evaluation.stage(id, after)?,
            ))
        });
        SheetScene {
            id: sheet.id,
            name: sheet.name.clone(),
            points: points.collect(),
            curves: sheet
                .curves
                .iter()
                .filter_map(|curve| {
                    let path = evaluation.curve(curve.id)?;
                    Some(CurveScene {
                        id: curve.id,
                        name: curve.name.clone(),
                        line: self.line(path, lines),
                        path: path.clone(),
                        is_traced: traced.contains(&curve.id),
                        handles: handles(curve),
                    })
                })
                .collect(),
            is_bare,
            on: sheet.on.map(|(panel, _)| panel),
            edges: laid.unwrap_or_default(),
        }
    }

    fn line(
        &mut self,
        path: &Arc<Path>,
        lines: &mut HashMap<*const Path, KeptLine>,
    ) -> Arc<[Vec2]> {
        let key = Arc::as_ptr(path);
        let kept = match self.lines.remove(&key) {
            Some(kept) => kept,
            None => {
                self.made += 1;
                KeptLine {
                    _path: path.clone(),
                    line: path.flatten(self.tolerance()).into(),
                }
            }
        };
        let line = kept.line.clone();
        lines.insert(key, kept);
        line
    }

    fn panel(
        &mut self,
        panel: &Panel,
        evaluation: &Evaluation,
        shapes: &mut HashMap<*const Stage, KeptShape>,
    ) -> Option<PanelScene> {
        let now = evaluation.last_stage(panel);
        let stage = now.or_else(|| evaluation.last_good_stage(panel))?;
        let key = Arc::as_ptr(stage);
        let kept = match self.shapes.remove(&key).or_else(|| shapes.remove(&key)) {
            Some(kept) => kept,
            None => {
                self.made += 1;
                KeptShape {
                    _stage: stage.clone(),
                    shape: Arc::new(PanelShape::new(stage, self.tolerance())),
                }
            }
        };
        let shape = kept.shape.clone();
        shapes.insert(key, kept);
        let corners = corners(panel, stage);
        Some(PanelScene {
            id: panel.id,
            sheet: evaluation.pattern().sheet_of(panel)?,
            name: panel.name.clone(),
            cut: cut_words(panel),
            left: left(&corners, stage, evaluation),
            corners,
            shape,
            fold_step: panel
                .operations
                .iter()
                .find(|step| matches!(step.kind, OperationKind::Fold { .. }))
                .map(|step| step.id),
            fold: fold_line(stage),
            pressed: press_arrows(stage, evaluation.pattern(), panel)
                .into_iter()
                .filter(|arrow| arrow.half == 0)
                .collect(),
            is_stale: now.is_none(),
        })
    }
}

impl Scene {
    /// Bounding box of a panel and its cut lines (m).
    pub fn room_of(&self, panel: &PanelScene) -> Bounds2 {
        let rings = self.cut_lines.of(panel.id).iter();
        let cut = rings.flatten().copied();
        Bounds2::of(cut.chain([panel.bounds().min, panel.bounds().max]))
    }
}

impl PanelScene {
    /// Bounding box on its sheet (m).
    pub fn bounds(&self) -> &Bounds2 {
        &self.shape.bounds
    }
}

impl SheetScene {
    /// Bounding box of the points and curves (m); `None` if the sheet has neither.
    pub fn bounds(&self) -> Option<Bounds2> {
        let points = self.points.iter().map(|point| point.at);
        let lines = self.curves.iter().flat_map(|curve| curve.line.iter());
        let all: Vec<Vec2> = points.chain(lines.copied()).collect();
        (!all.is_empty()).then(|| Bounds2::of(all))
    }
}

/// Pairs of points of a spline: an end or an inner knot, and one of its handles; empty for other curves.
fn handles(curve: &Curve) -> Vec<[PointId; 2]> {
    let CurveRule::Spline { handles, knots, .. } = &curve.rule else {
        return Vec::new();
    };
    let inner = knots
        .iter()
        .flat_map(|knot| [[knot.point, knot.before], [knot.point, knot.after]]);
    let ends = [[curve.ends[0], handles[0]], [curve.ends[1], handles[1]]];
    ends.into_iter().chain(inner).collect()
}

/// Drafted corners of a panel: end points of its edges; for a part of a split panel the drafted corners on
/// that part.
fn corners(panel: &Panel, stage: &Stage) -> BTreeSet<PointId> {
    if panel.sheet().is_some() {
        return panel.edges().flat_map(|edge| edge.ends).collect();
    }
    let edges = stage.lines.iter().flat_map(|line| &line.edges);
    let starts = edges.filter_map(|edge| match edge.start {
        Some(Name::Drawn(id)) => Some(id),
        _ => None,
    });
    starts.collect()
}

/// Corners that operations moved: no edge of the stage ends at their drafted places.
fn left(corners: &BTreeSet<PointId>, stage: &Stage, evaluation: &Evaluation) -> BTreeSet<PointId> {
    let edges = stage.lines.iter().flat_map(|line| &line.edges);
    let ends = edges.flat_map(|edge| [edge.curve.start(), edge.curve.end()]);
    let ends: Vec<Vec2> = ends.collect();
    let is_left = |id: &&PointId| {
        let at = evaluation.point(**id);
        at.is_some_and(|at| ends.iter().all(|end| (end - at).norm() > AT_CORNER))
    };
    corners.iter().filter(is_left).copied().collect()
}

/// Both ends of the fold line of a stage that was unfolded: the ends of the drafted half. `None` without a
/// mirrored half.
pub fn fold_line(stage: &Stage) -> Option<[Vec2; 2]> {
    let ring = stage.outline();
    let count = ring.len();
    let begins = |k: &usize| ring[*k].half == 0 && ring[(k + count - 1) % count].half != 0;
    let first = (0..count).find(begins)?;
    let own = (first..first + count).take_while(|k| ring[k % count].half == 0);
    let last = own.last()? % count;
    Some([ring[last].curve.end(), ring[first].curve.start()])
}

fn cut_words(panel: &Panel) -> String {
    let mut kinds = panel.operations.iter().map(|step| &step.kind);
    let is_folded = kinds.any(|kind| matches!(kind, OperationKind::Fold { .. }));
    match (panel.cut.quantity, panel.cut.mirrored, is_folded) {
        (0, ..) => "not cut".into(),
        (1, _, false) => String::new(),
        (1, _, true) => "cut on the fold".into(),
        (n, true, _) => format!("cut {n}, mirrored"),
        (n, false, true) => format!("cut {n} on the fold"),
        (n, false, false) => format!("cut {n}"),
    }
}
