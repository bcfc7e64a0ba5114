//! Small drafts for tests: garments of straight edges drawn in a few lines.

pub mod edits;

use toile_assembly::{Levels, Limb, PlacementBody};
use toile_geometry::{Curve, SurfaceTree, TriangleMesh, Vec2, Vec3};
use toile_pattern::{
    BodyPart, Draft, DraftSeam, DraftSpan, EdgeCorner, EdgeId, EdgeOrigin, Facing, PanelId, Piece,
    PieceEdge, PieceId, SeamId, SeamOrigin, Worn,
};

/// Edges along corners (m), closed.
pub fn polygon(corners: &[[f64; 2]]) -> Vec<PieceEdge> {
    let curves: Vec<Curve> = (0..corners.len())
        .map(|k| Curve::Line {
            start: corners[k].into(),
            end: corners[(k + 1) % corners.len()].into(),
        })
        .collect();
    edges(&curves)
}

pub fn edges(curves: &[Curve]) -> Vec<PieceEdge> {
    curves
        .iter()
        .enumerate()
        .map(|(k, &curve)| PieceEdge {
            origin: EdgeOrigin::drawn(EdgeId(k as u32)),
            curve,
            seam_allowance: 0.0,
            corner: EdgeCorner::default(),
            reversed: false,
        })
        .collect()
}

pub fn piece(number: u32, name: &str, outline: Vec<PieceEdge>, worn: Worn) -> Piece {
    Piece {
        id: PieceId {
            panel: PanelId(number),
            copy: 0,
        },
        name: name.to_owned(),
        outline,
        holes: Vec::new(),
        internal_lines: Vec::new(),
        notches: Vec::new(),
        darts: Vec::new(),
        pressed: Vec::new(),
        folds: Vec::new(),
        grain: std::f64::consts::FRAC_PI_2,
        fabric: 0,
        worn,
        sewn: true,
    }
}

pub fn worn(part: BodyPart, facing: Facing) -> Worn {
    Worn::Wrapped {
        part,
        facing,
        level: None,
    }
}

/// A span of a piece's edge.
pub fn span(piece: usize, edge: usize, from: f64, to: f64) -> DraftSpan {
    DraftSpan {
        piece,
        edge,
        from,
        to,
    }
}

pub fn seam(number: u32, a: Vec<DraftSpan>, b: Vec<DraftSpan>) -> DraftSeam {
    DraftSeam {
        id: SeamOrigin::Seam(SeamId(number)),
        name: format!("seam {number}"),
        sides: [a, b],
        gathered: false,
        right_sides_together: true,
        multi_ply: false,
    }
}

pub fn draft(pieces: Vec<Piece>, seams: Vec<(Vec<DraftSpan>, Vec<DraftSpan>)>) -> Draft {
    Draft {
        name: "test".to_owned(),
        pieces,
        seams: seams
            .into_iter()
            .enumerate()
            .map(|(k, (a, b))| seam(k as u32, a, b))
            .collect(),
        fabrics: Vec::new(),
    }
}

fn arc(start: [f64; 2], end: [f64; 2], bulge: f64) -> Curve {
    Curve::Arc {
        start: start.into(),
        end: end.into(),
        bulge,
    }
}

fn line(start: [f64; 2], end: [f64; 2]) -> Curve {
    Curve::Line {
        start: start.into(),
        end: end.into(),
    }
}

fn cubic(p: [[f64; 2]; 4]) -> Curve {
    Curve::Cubic {
        start: p[0].into(),
        controls: [p[1].into(), p[2].into()],
        end: p[3].into(),
    }
}

/// Front or back of a T-shirt: hem, right side seam, armhole, shoulder, neck, and mirrored.
fn tee_body(neck_depth: f64) -> Vec<PieceEdge> {
    let (w, s, n) = (0.27, 0.215, 0.085);
    edges(&[
        line([-w, 0.0], [w, 0.0]),
        line([w, 0.0], [w, 0.42]),
        cubic([[w, 0.42], [s, 0.43], [s - 0.02, 0.5], [s, 0.61]]),
        line([s, 0.61], [n, 0.65]),
        cubic([
            [n, 0.65],
            [n - 0.01, 0.65 - neck_depth],
            [-n + 0.01, 0.65 - neck_depth],
            [-n, 0.65],
        ]),
        line([-n, 0.65], [-s, 0.61]),
        cubic([[-s, 0.61], [-s + 0.02, 0.5], [-s, 0.43], [-w, 0.42]]),
        line([-w, 0.42], [-w, 0.0]),
    ])
}

/// A short sleeve: hem, two underarm seams, a cap in two halves.
fn tee_sleeve() -> Vec<PieceEdge> {
    let (w, hem) = (0.2, 0.17);
    edges(&[
        line([-hem, -0.2], [hem, -0.2]),
        line([hem, -0.2], [w, -0.1]),
        cubic([[w, -0.1], [w - 0.08, -0.09], [0.08, 0.0], [0.0, 0.0]]),
        cubic([[0.0, 0.0], [-0.08, 0.0], [-w + 0.08, -0.09], [-w, -0.1]]),
        line([-w, -0.1], [-hem, -0.2]),
    ])
}

/// A T-shirt: front, back, left and right sleeve.
pub fn tee() -> Draft {
    use BodyPart::{LeftArm, RightArm, Trunk};
    let pieces = vec![
        piece(0, "front", tee_body(0.16), worn(Trunk, Facing::Front)),
        piece(1, "back", tee_body(0.05), worn(Trunk, Facing::Back)),
        piece(
            2,
            "left sleeve",
            tee_sleeve(),
            worn(LeftArm, Facing::Around),
        ),
        piece(
            3,
            "right sleeve",
            tee_sleeve(),
            worn(RightArm, Facing::Around),
        ),
    ];
    let all = |p, e| vec![span(p, e, 0.0, 1.0)];
    let back = |p, e| vec![span(p, e, 1.0, 0.0)];
    // Seen from outside, the wearer's left is at +x of the front and at -x of the back.
    draft(
        pieces,
        vec![
            (all(0, 1), back(1, 7)),
            (all(0, 7), back(1, 1)),
            (all(0, 3), back(1, 5)),
            (all(0, 5), back(1, 3)),
            (all(2, 1), back(2, 4)),
            (all(3, 1), back(3, 4)),
            (all(0, 2), back(2, 3)),
            (all(1, 6), back(2, 2)),
            (all(0, 6), back(3, 2)),
            (all(1, 2), back(3, 3)),
        ],
    )
}

/// Trousers: front and back of each leg and a waistband in one.
pub fn trousers() -> Draft {
    use BodyPart::{LeftLeg, RightLeg, Trunk};
    // A front seen from outside, crotch at -x: the wearer's left leg.
    let leg = |crotch: f64, width: f64| {
        edges(&[
            line([-0.12, 0.0], [0.12, 0.0]),
            line([0.12, 0.0], [width, 1.02]),
            line([width, 1.02], [width - 0.25, 1.02]),
            cubic([
                [width - 0.25, 1.02],
                [width - 0.25, 0.85],
                [width - 0.25, 0.76],
                [width - 0.25 - crotch, 0.75],
            ]),
            line([width - 0.25 - crotch, 0.75], [-0.12, 0.0]),
        ])
    };
    let mirrored = |outline: Vec<PieceEdge>| -> Vec<PieceEdge> {
        let mut flipped: Vec<Curve> = outline
            .iter()
            .map(|e| e.curve.reflected(Vec2::zeros(), Vec2::y()).reversed())
            .collect();
        flipped.reverse();
        edges(&flipped)
    };
    let band = polygon(&[[-0.5, 0.0], [0.5, 0.0], [0.5, 0.04], [-0.5, 0.04]]);
    let pieces = vec![
        piece(
            0,
            "front left",
            leg(0.05, 0.13),
            worn(LeftLeg, Facing::Front),
        ),
        piece(
            1,
            "back left",
            mirrored(leg(0.1, 0.14)),
            worn(LeftLeg, Facing::Back),
        ),
        piece(
            2,
            "front right",
            mirrored(leg(0.05, 0.13)),
            worn(RightLeg, Facing::Front),
        ),
        piece(
            3,
            "back right",
            leg(0.1, 0.14),
            worn(RightLeg, Facing::Back),
        ),
        piece(4, "waistband", band, worn(Trunk, Facing::Around)),
    ];
    // Mirroring turns edge k into edge 4 - k.
    let all = |p, e| vec![span(p, e, 0.0, 1.0)];
    let back = |p, e| vec![span(p, e, 1.0, 0.0)];
    draft(
        pieces,
        vec![
            (all(0, 1), back(1, 3)),
            (all(0, 4), back(1, 0)),
            (all(2, 3), back(3, 1)),
            (all(2, 0), back(3, 4)),
            (all(0, 3), back(2, 1)),
            (all(1, 1), back(3, 3)),
            (all(4, 1), back(4, 3)),
            (
                vec![span(4, 0, 0.0, 1.0)],
                vec![
                    span(3, 2, 1.0, 0.0),
                    span(2, 2, 1.0, 0.0),
                    span(0, 2, 1.0, 0.0),
                    span(1, 2, 1.0, 0.0),
                ],
            ),
        ],
    )
}

/// A gathered skirt: two wide rectangles and a waistband.
pub fn skirt() -> Draft {
    use BodyPart::Trunk;
    let panel = polygon(&[[-0.6, 0.0], [0.6, 0.0], [0.6, 0.6], [-0.6, 0.6]]);
    let band = polygon(&[[-0.37, 0.0], [0.37, 0.0], [0.37, 0.035], [-0.37, 0.035]]);
    let pieces = vec![
        piece(0, "skirt front", panel.clone(), worn(Trunk, Facing::Front)),
        piece(1, "skirt back", panel, worn(Trunk, Facing::Back)),
        piece(2, "waistband", band, worn(Trunk, Facing::Around)),
    ];
    let mut draft = draft(
        pieces,
        vec![
            (vec![span(0, 1, 0.0, 1.0)], vec![span(1, 3, 1.0, 0.0)]),
            (vec![span(0, 3, 0.0, 1.0)], vec![span(1, 1, 1.0, 0.0)]),
            (vec![span(2, 1, 0.0, 1.0)], vec![span(2, 3, 1.0, 0.0)]),
            (
                vec![span(2, 0, 0.0, 1.0)],
                vec![
                    span(1, 2, 0.5, 0.0),
                    span(0, 2, 1.0, 0.0),
                    span(1, 2, 1.0, 0.5),
                ],
            ),
        ],
    );
    draft.seams[3].gathered = true;
    draft
}

/// A round poncho with a hole for the head.
pub fn poncho() -> Draft {
    let ring = |r: f64, bulge: f64| {
        [
            arc([r, 0.0], [-r, 0.0], bulge),
            arc([-r, 0.0], [r, 0.0], bulge),
        ]
    };
    let mut cloth = piece(
        0,
        "poncho",
        edges(&ring(0.6, 1.0)),
        worn(BodyPart::Trunk, Facing::Over),
    );
    let hole = ring(0.14, -1.0);
    let turned = [hole[0], hole[1]];
    cloth.holes.push(edges(&turned));
    draft(vec![cloth], Vec::new())
}

/// A closed tube of elliptic sections, capped, from the first to the last.
fn tube(mesh: &mut TriangleMesh, sections: &[(Vec3, Vec3, Vec3)]) {
    let count = 24u32;
    let base = mesh.positions.len() as u32;
    for (centre, a, b) in sections {
        for k in 0..count {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
            mesh.positions
                .push(centre + a * angle.cos() + b * angle.sin());
        }
    }
    for s in 0..sections.len() as u32 - 1 {
        for k in 0..count {
            let (i, j) = (base + s * count + k, base + s * count + (k + 1) % count);
            mesh.triangles.push([i, j, j + count]);
            mesh.triangles.push([i, j + count, i + count]);
        }
    }
    for (end, flip) in [(0, true), (sections.len() as u32 - 1, false)] {
        let centre = mesh.positions.len() as u32;
        mesh.positions.push(sections[end as usize].0);
        for k in 0..count {
            let (i, j) = (base + end * count + k, base + end * count + (k + 1) % count);
            mesh.triangles
                .push(if flip { [centre, j, i] } else { [centre, i, j] });
        }
    }
}

/// A figure of elliptic tubes, 1.70 m tall, arms half raised.
pub struct Doll {
    pub tree: SurfaceTree,
    limbs: Vec<Limb>,
}

impl Doll {
    pub fn new() -> Self {
        let mut mesh = TriangleMesh::default();
        let flat = |x: f64, y: f64, z: f64, a: f64, b: f64| {
            // Seen from the tip of an upward tube, x to z is clockwise.
            (
                Vec3::new(x, y, z),
                Vec3::new(a, 0.0, 0.0),
                Vec3::new(0.0, 0.0, -b),
            )
        };
        tube(
            &mut mesh,
            &[
                flat(0.0, 0.76, 0.0, 0.16, 0.1),
                flat(0.0, 0.88, 0.0, 0.175, 0.115),
                flat(0.0, 1.04, 0.0, 0.135, 0.09),
                flat(0.0, 1.22, 0.0, 0.165, 0.115),
                flat(0.0, 1.36, 0.0, 0.165, 0.075),
                flat(0.0, 1.42, 0.0, 0.06, 0.06),
                flat(0.0, 1.5, 0.01, 0.055, 0.06),
            ],
        );
        tube(
            &mut mesh,
            &[
                flat(0.0, 1.48, 0.015, 0.05, 0.06),
                flat(0.0, 1.56, 0.02, 0.075, 0.095),
                flat(0.0, 1.66, 0.015, 0.07, 0.09),
                flat(0.0, 1.7, 0.01, 0.03, 0.04),
            ],
        );
        let mut limbs = vec![
            limb(BodyPart::Trunk, &[[0.0, 0.78, 0.0], [0.0, 1.42, 0.0]]),
            limb(BodyPart::Head, &[[0.0, 1.42, 0.0], [0.0, 1.7, 0.01]]),
        ];
        for (side, arm, leg) in [
            (1.0, BodyPart::LeftArm, BodyPart::LeftLeg),
            (-1.0, BodyPart::RightArm, BodyPart::RightLeg),
        ] {
            let down = Vec3::new(side * 0.7, -0.714, 0.0);
            let across = Vec3::new(0.714, 0.7 * side, 0.0);
            let shoulder = Vec3::new(side * 0.165, 1.355, 0.0);
            let section =
                |along: f64, r: f64| (shoulder + down * along, Vec3::z() * r, across * -r);
            tube(
                &mut mesh,
                &[
                    section(0.0, 0.055),
                    section(0.28, 0.045),
                    section(0.53, 0.028),
                    section(0.7, 0.03),
                ],
            );
            limbs.push(Limb {
                part: arm,
                axis: vec![shoulder, shoulder + down * 0.28, shoulder + down * 0.53],
            });
            tube(
                &mut mesh,
                &[
                    flat(side * 0.15, 0.0, 0.0, 0.045, 0.08),
                    flat(side * 0.14, 0.1, 0.0, 0.04, 0.04),
                    flat(side * 0.12, 0.45, 0.0, 0.055, 0.06),
                    flat(side * 0.085, 0.8, 0.0, 0.08, 0.085),
                ],
            );
            limbs.push(limb(
                leg,
                &[
                    [side * 0.085, 0.85, 0.0],
                    [side * 0.12, 0.45, 0.0],
                    [side * 0.14, 0.08, 0.0],
                ],
            ));
        }
        Self {
            tree: SurfaceTree::new(mesh),
            limbs,
        }
    }

    pub fn body(&self) -> PlacementBody<'_> {
        PlacementBody {
            skin: &self.tree,
            limbs: self.limbs.clone(),
            levels: Levels {
                crown: 1.7,
                neck: 1.43,
                shoulder: 1.38,
                chest: 1.24,
                waist: 1.04,
                hip: 0.88,
                crotch: 0.76,
            },
        }
    }
}

fn limb(part: BodyPart, axis: &[[f64; 3]]) -> Limb {
    Limb {
        part,
        axis: axis.iter().map(|&p| p.into()).collect(),
    }
}
