//! Converts a specification to a pattern document.

use super::specification::{self, SpecPanel, SpecStitch, Specification};
use crate::FormatError;
use crate::part_names::part_name;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use toile_fabric::Material;
use toile_geometry::{Curve, Vec2, Vec3};
use toile_pattern::{
    CurveRule, Edge, EdgeId, Fabric, FabricId, LineKind, PanelBuilder, Pattern, PointId, PointRule,
    Seam, SeamId, Span, WornRule,
};

/// A seam with sides that differ in length by more than this ratio counts as gathered on purpose.
const GATHER_RATIO: f64 = 1.05;
/// Limit for the cosine of the angle between two sewn edges, both in the direction of sewing: below it the
/// seam is reported as perhaps twisted.
const TWIST_COSINE: f64 = -0.7;
/// Limit for the cosine of the angle between two edges: only where its magnitude is above this limit do the
/// positions in space tell which ends of the edges meet.
const CLEAR_COSINE: f64 = 0.7;

/// The result of reading a file.
#[derive(Clone, Debug)]
pub struct GarmentCodeReading {
    /// The pattern.
    pub pattern: Pattern,
    /// Notes on parts that were left out or assumed, with the place in the file.
    pub notes: Vec<FormatError>,
}

/// Reads a GarmentCode specification.
///
/// Coordinates are converted to metres. Panels keep their winding and their placement in space: a clockwise
/// panel is one drawn from its wrong side. A stitch sews the start of one edge to the end of the other, which
/// puts right sides together and keeps the garment orientable; `right_wrong` sews start to start. Files of
/// the older kind (curvatures as bare lists, or absolute coordinates) may be wound either way; for them the
/// sewing direction is the one that leaves the ends nearer to each other in space. Two edges of one panel
/// that share a vertex (the legs of a dart) are sewn so that they meet at that vertex. A seam with sides that
/// differ in length by more than 5 % is gathered; smaller differences are ease.
///
/// # Errors
/// Text that is not such a specification: the path of the place and a remedy.
pub fn read_garmentcode(text: &str) -> Result<GarmentCodeReading, FormatError> {
    let specification = specification::read(text)?;
    let mut builder = Builder::default();
    builder.notes.clone_from(&specification.notes);
    let fabric: FabricId = builder.pattern.ids.take();
    builder.pattern.fabrics.push(Arc::new(Fabric {
        id: fabric,
        name: "cotton weave".to_owned(),
        material: Material {
            density: 0.2,
            thickness: 5e-4,
            stretch: [1500.0, 1500.0],
            shear: 80.0,
            poisson: 0.3,
            bend: [1.5e-5; 3],
            friction: 0.4,
            ..Material::default()
        },
        width: 1.5,
        nap: false,
        colour: [0.45, 0.58, 0.72],
    }));
    builder.right_sides_out = specification.older && right_sides_out(&specification);
    for panel in &specification.panels {
        builder.add_panel(panel, fabric);
    }
    builder.add_seams(&specification);
    Ok(GarmentCodeReading {
        pattern: builder.pattern,
        notes: builder.notes,
    })
}

/// Edge of the document made from an edge of the file: its id, and whether the document walks the file's edge
/// backwards.
type Place = (EdgeId, bool);

#[derive(Default)]
struct Builder {
    pattern: Pattern,
    notes: Vec<FormatError>,
    /// Names of panels that are taken.
    names: BTreeSet<String>,
    /// For each panel of the file and each of its edges, the edge of the document that was made from it.
    edges: Vec<Vec<Option<Place>>>,
    /// Whether all outlines of an older file are wound as seen from the right side.
    right_sides_out: bool,
}

impl Builder {
    fn add_panel(&mut self, source: &SpecPanel, fabric: toile_pattern::FabricId) {
        let name = part_name(&source.name, &mut self.names);
        if name != source.name {
            self.notes.push(FormatError::new(
                format!("pattern.panels.{}", source.name),
                format!("the panel is called \"{name}\" here"),
                "names have 1 to 80 characters and no quotes",
            ));
        }
        let mut ids = self.pattern.ids;
        let mut drawing = PanelBuilder::new(&mut ids, &name, fabric);
        let translation = source.place.translation.vector;
        drawing.panel.worn = WornRule::Placed {
            translation: translation.into(),
            rotation: source.place.rotation.coords.into(),
        };
        let mut corners: BTreeMap<usize, PointId> = BTreeMap::new();
        let mut places = vec![None; source.edges.len()];
        let mut labels = label_counts(source);
        let outline_turns = turning(source, 0);
        for (k, walk) in source.loops.iter().enumerate() {
            let mut walk = walk.clone();
            if k > 0 && turning(source, k) == outline_turns {
                walk.reverse();
                for (_, backwards) in &mut walk {
                    *backwards = !*backwards;
                }
            }
            let mut contour = Vec::with_capacity(walk.len());
            for (index, backwards) in walk {
                let edge = self.add_edge(
                    &mut drawing,
                    source,
                    (index, backwards),
                    &mut corners,
                    &mut labels,
                );
                places[index] = Some((edge.id, backwards));
                contour.push(edge);
            }
            let (name, kind) = match k {
                0 => ("outline".to_owned(), LineKind::Outline),
                _ => (format!("hole {k}"), LineKind::Hole),
            };
            drawing.line(name, kind, contour);
        }
        let drawn = drawing.done();
        self.pattern.ids = ids;
        self.edges.push(places);
        self.pattern.add(drawn);
    }

    fn add_edge(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        source: &SpecPanel,
        (index, backwards): (usize, bool),
        corners: &mut BTreeMap<usize, PointId>,
        labels: &mut BTreeMap<String, usize>,
    ) -> Edge {
        let spec = &source.edges[index];
        let mut ends = [PointId::default(); 2];
        for (k, end) in ends.iter_mut().enumerate() {
            let vertex = spec.ends[k];
            let at = if k == 0 {
                spec.curve.start()
            } else {
                spec.curve.end()
            };
            *end = *corners
                .entry(vertex)
                .or_insert_with(|| drawing.point(format!("p{vertex}"), PointRule::at(at.x, at.y)));
        }
        let mut handle = |number: usize, p: Vec2| {
            drawing.point(format!("e{index}c{number}"), PointRule::at(p.x, p.y))
        };
        let mut rule = match spec.curve {
            Curve::Line { .. } => CurveRule::Line,
            Curve::Arc { bulge, .. } => CurveRule::Arc {
                bulge: (if backwards { -bulge } else { bulge }).into(),
            },
            Curve::Quadratic {
                start,
                control,
                end,
            } => {
                let third = |from: Vec2| from + (control - from) * (2.0 / 3.0);
                CurveRule::cubic([handle(1, third(start)), handle(2, third(end))])
            }
            Curve::Cubic { controls, .. } => {
                CurveRule::cubic([handle(1, controls[0]), handle(2, controls[1])])
            }
        };
        if backwards {
            ends.reverse();
            if let CurveRule::Spline { handles, .. } = &mut rule {
                handles.reverse();
            }
        }
        let plain = format!("e{index}");
        let name = match &spec.label {
            Some(label) if labels.get(label) == Some(&1) && !is_plain(label) => label.clone(),
            Some(label) => {
                self.notes.push(FormatError::new(
                    format!("pattern.panels.{}.edges[{index}].label", source.name),
                    format!("the label \"{label}\" is not kept: it is not unique in its panel"),
                    "name the edge in the pattern",
                ));
                plain
            }
            None => plain,
        };
        drawing.edge(name, ends, rule)
    }

    fn add_seams(&mut self, specification: &Specification) {
        let mut uses: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for stitch in &specification.stitches {
            for side in stitch.sides {
                *uses.entry(side).or_default() += 1;
            }
        }
        let mut names = BTreeSet::new();
        for stitch in &specification.stitches {
            let against = self.runs_against(specification, stitch);
            let mut spans = Vec::new();
            for (panel, edge) in stitch.sides {
                let Some((id, backwards)) = self.edges[panel][edge] else {
                    continue;
                };
                let Some(span) = self.pattern.panels[panel].span(id) else {
                    continue;
                };
                let flip = backwards != (spans.len() == 1 && against);
                spans.push(if flip { span.reversed() } else { span });
            }
            let Ok([first, second]) = <[Span; 2]>::try_from(spans) else {
                continue;
            };
            let lengths = stitch
                .sides
                .map(|(panel, edge)| specification.panels[panel].edges[edge].curve.length());
            let label = |(panel, edge): (usize, usize)| {
                let name: String = self.pattern.panels[panel].name.chars().take(30).collect();
                format!("{} e{edge}", name.trim())
            };
            let name = format!("{} to {}", label(stitch.sides[0]), label(stitch.sides[1]));
            let name = part_name(&name, &mut names);
            let (longer, shorter) = (lengths[0].max(lengths[1]), lengths[0].min(lengths[1]));
            let mut seam = Seam::new(
                self.pattern.ids.take::<SeamId>(),
                name,
                [vec![first], vec![second]],
            );
            seam.gathered = longer > GATHER_RATIO * shorter;
            // Rounded up to whole micrometres, so that the check of the ease always passes.
            seam.ease = (((longer - shorter) * 1e6).ceil() * 1e-6 + 1e-6).into();
            seam.right_sides_together = !stitch.right_wrong;
            seam.multi_ply = stitch.sides.iter().any(|side| uses[side] > 1);
            if seam.multi_ply {
                self.notes.push(FormatError::new(
                    &stitch.path,
                    "one of its edges is in another stitch too",
                    "it is sewn as more than two plies",
                ));
            }
            self.pattern.seams.push(Arc::new(seam));
        }
    }

    /// Whether the start of one edge is sewn to the end of the other.
    fn runs_against(&mut self, specification: &Specification, stitch: &SpecStitch) -> bool {
        if stitch.sides[0].0 == stitch.sides[1].0 {
            let panel = &specification.panels[stitch.sides[0].0];
            let [e, f] = stitch.sides.map(|(_, edge)| panel.edges[edge].ends);
            if e[0] == f[0] || e[1] == f[1] {
                return false;
            }
            if e[0] == f[1] || e[1] == f[0] {
                return true;
            }
        }
        let placed = PlacedStitch::new(specification, stitch);
        if specification.older {
            return (self.right_sides_out && !placed.is_clear()) || placed.nearer_ends_run_against;
        }
        let rule = !stitch.right_wrong;
        let cosine = placed.cosine;
        if (if rule { -cosine } else { cosine }) < TWIST_COSINE {
            self.notes.push(FormatError::new(
                &stitch.path,
                "its edges run against each other in space: the seam may be twisted",
                "check \"right_wrong\" and the places of the two panels",
            ));
        }
        rule
    }
}

/// The two edges of a stitch as placed in space.
struct PlacedStitch {
    /// Cosine of the angle between the edges.
    cosine: f64,
    /// Whether the ends lie nearer to each other with start sewn to end than with start sewn to start.
    nearer_ends_run_against: bool,
}

impl PlacedStitch {
    fn new(specification: &Specification, stitch: &SpecStitch) -> Self {
        let [a, b] = stitch.sides.map(|(panel, edge)| {
            let panel = &specification.panels[panel];
            let curve = &panel.edges[edge].curve;
            [curve.start(), curve.end()].map(|p| {
                panel.place.rotation * Vec3::new(p.x, p.y, 0.0) + panel.place.translation.vector
            })
        });
        let [same, against] =
            [[0, 1], [1, 0]].map(|order| (a[0] - b[order[0]]).norm() + (a[1] - b[order[1]]).norm());
        let [along, beside] = [a, b].map(|ends| ends[1] - ends[0]);
        Self {
            cosine: along.dot(&beside) / (along.norm() * beside.norm()).max(f64::MIN_POSITIVE),
            nearer_ends_run_against: against <= same,
        }
    }

    /// Whether the positions in space tell which ends meet. For edges at right angles, such as a hood's side
    /// and the neck, neither pairing of ends is nearer by design.
    fn is_clear(&self) -> bool {
        self.cosine.abs() > CLEAR_COSINE
    }
}

/// Whether all outlines are wound as seen from the right side. They are if the edges of two panels are sewn
/// start to end wherever the positions in space tell which ends meet.
fn right_sides_out(specification: &Specification) -> bool {
    let between = |stitch: &&SpecStitch| stitch.sides[0].0 != stitch.sides[1].0;
    let stitches = specification.stitches.iter().filter(between);
    let mut placed = stitches.map(|stitch| PlacedStitch::new(specification, stitch));
    placed.all(|stitch| stitch.nearer_ends_run_against || !stitch.is_clear())
}

/// Whether an edge cannot take its label as its name: it is no valid name, or one that unlabelled edges get.
fn is_plain(label: &str) -> bool {
    let clean = toile_pattern::is_part_name(label);
    let digits = label
        .strip_prefix('e')
        .is_some_and(|d| !d.is_empty() && d.chars().all(|c| c.is_ascii_digit()));
    !clean || digits
}

/// Number of edges of a panel with each label.
fn label_counts(panel: &SpecPanel) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for label in panel.edges.iter().filter_map(|e| e.label.as_ref()) {
        *counts.entry(label.clone()).or_default() += 1;
    }
    counts
}

/// Whether a loop of a panel is wound counter-clockwise.
fn turning(panel: &SpecPanel, index: usize) -> bool {
    specification::loop_area(&panel.edges, &panel.loops[index]) > 0.0
}
