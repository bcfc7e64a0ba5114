//! Our own body fitted to closed meshes.

use crate::common::{obj, shared};
use toile_body::{Description, Figure, Fit, Joint, Mannequin, Scan, ScanLandmarks};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// A published body as a scan.
fn scan(path: &std::path::Path) -> Scan {
    let mesh = obj(&std::fs::read_to_string(path).unwrap());
    Scan::new(mesh, ScanLandmarks::default()).unwrap()
}

/// Girths of trunk and leg of the finished skin against the mesh's by a tape of this test's own:
/// hulls of level cuts between those the fit was judged by. Root mean square (m).
fn independent_tape(mesh: &Scan, body: &Mannequin) -> f64 {
    let height = mesh.height();
    let marks = mesh.landmarks();
    let (crotch, armpit) = (marks.crotch.unwrap(), marks.armpit.unwrap());
    // The hull's lower and upper chain (Andrew 1979).
    let girth = |mesh: &TriangleMesh, y: f64, is_leg: bool| -> f64 {
        let mut points: Vec<[f64; 2]> = Vec::new();
        let reach = if is_leg { 0.0 } else { -1.0 };
        for t in 0..mesh.triangles.len() {
            let corners = mesh.corners(t);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                if (a.y >= y) != (b.y >= y) {
                    let p = a + (b - a) * ((y - a.y) / (b.y - a.y));
                    points.push([p.x, p.z]);
                }
            }
        }
        let wide = if is_leg { 0.13 } else { 0.15 };
        points.retain(|p| p[0] > reach * height && p[0].abs() < wide * height);
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let chain = |points: &mut dyn Iterator<Item = &[f64; 2]>| -> f64 {
            let mut hull: Vec<[f64; 2]> = Vec::new();
            for &p in points {
                while let [.., a, b] = hull[..] {
                    let turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                    if turn > 0.0 {
                        break;
                    }
                    hull.pop();
                }
                hull.push(p);
            }
            let step = |w: &[[f64; 2]]| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
            hull.windows(2).map(step).sum()
        };
        chain(&mut points.iter()) + chain(&mut points.iter().rev())
    };
    let (mut sum, mut count) = (0.0, 0.0);
    let mut add = |y: f64, is_leg: bool| {
        let [a, b] = [mesh.mesh(), body.skin()].map(|m| girth(m, y, is_leg));
        sum += (a - b) * (a - b);
        count += 1.0;
    };
    // Legs apart, and the trunk where the arms hang clear of it.
    for k in 5..40 {
        let y = (0.01 * f64::from(k) + 0.0033) * height;
        if y < crotch - 0.03 * height {
            add(y, true);
        }
    }
    for k in 0..60 {
        let y = (0.005 * f64::from(k) + 0.0033) * height + crotch;
        if (crotch + 0.02 * height..armpit - 0.13 * height).contains(&y) {
            add(y, false);
        }
    }
    (sum / count).sqrt()
}

fn report(name: &str, fit: &Fit, body: &Mannequin) {
    let m = &fit.misfit;
    println!(
        "{name}: {} primitives, {} sections, radial {:.2} mm rms {:.1} most (trunk, legs, arms {:.2?}), girth {:.2} rms {:.1} most, {} crossings",
        m.primitives,
        m.sections,
        m.radial * 1e3,
        m.radial_max * 1e3,
        m.parts.map(|x| x * 1e3),
        m.girth * 1e3,
        m.girth_max * 1e3,
        SurfaceTree::new(body.skin().clone())
            .self_intersections()
            .len(),
    );
}

#[test]
fn published_bodies_within_two_millimetres() {
    // Two of them, all with TOILE_ALL=1.
    let names = [
        "male-child-averagemuscle-averageweight",
        "female-young-averagemuscle-averageweight",
        "female-child-averagemuscle-averageweight",
        "female-old-averagemuscle-averageweight",
        "female-young-averagemuscle-maxweight",
        "male-old-averagemuscle-averageweight",
        "male-young-averagemuscle-averageweight",
        "male-young-averagemuscle-maxweight",
    ];
    let count = if std::env::var("TOILE_ALL").is_ok() {
        8
    } else {
        2
    };
    for name in &names[..count] {
        let Some(path) = shared(&format!("body/makehuman/{name}.obj")) else {
            return;
        };
        let mesh = scan(&path);
        let fit = mesh.fit(Figure::Mean).unwrap();
        let body = Mannequin::from_description(&fit.description).unwrap();
        report(name, &fit, &body);
        assert!(fit.misfit.primitives <= 150);
        assert!(fit.misfit.sections > 80);
        assert!(fit.misfit.radial <= 2.0e-3, "{name}: {}", fit.misfit.radial);
        assert!(fit.misfit.girth <= 3.0e-3, "{name}: {}", fit.misfit.girth);
        assert_eq!(fit.misfit.self_crossings, 0, "{name}");
        assert_eq!(fit.misfit.levels.len(), fit.misfit.sections);
        let tape = independent_tape(&mesh, &body);
        println!("{name}: {:.2} mm by another tape", tape * 1e3);
        assert!(tape <= 3.0e-3, "{name}: {tape}");
        assert!(body.skin().is_closed_and_oriented());
        assert_eq!(body.skin().euler_characteristic(), 2);
        assert!(body.skin().volume() > 0.97 * mesh.mesh().volume());
        assert!(body.skin().volume() < 1.03 * mesh.mesh().volume());
        // It moves as any of our bodies does.
        let walk = toile_body::Clip::walk(body.skeleton());
        let posed = body.posed_skin(&walk.pose_for(body.skeleton(), 0.3));
        let change = posed.volume() / body.skin().volume();
        assert!((0.95..1.05).contains(&change), "{name}: {change}");
    }
}

#[test]
fn our_own_body_is_fitted_wherever_it_stands() {
    let own = Mannequin::new(&Figure::Man.average(), Figure::Man).unwrap();
    let mut mesh = own.skin().clone();
    for p in &mut mesh.positions {
        *p += Vec3::new(0.4, -0.2, 0.0);
    }
    let there = Scan::new(mesh, ScanLandmarks::default()).unwrap();
    let fit = there.fit(Figure::Man).unwrap();
    assert!((fit.shift - Vec3::new(-0.4, 0.2, 0.0)).norm() < 1e-3);
    assert!(fit.misfit.radial < 2e-3, "{}", fit.misfit.radial);
    let body = Mannequin::from_description(&fit.description).unwrap();
    report("our own man", &fit, &body);
    // The same fit gives the same body.
    let again = Mannequin::from_description(&body.description()).unwrap();
    assert_eq!(again.skin(), body.skin());
}

#[test]
fn what_cannot_be_fitted_is_refused_with_a_remedy() {
    // A post has neither arms nor legs.
    let mut mesh = TriangleMesh::default();
    for y in [0.0, 1.7] {
        for [x, z] in [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]] {
            mesh.positions.push(Vec3::new(x, y, z));
        }
    }
    mesh.triangles = vec![
        [0, 1, 2],
        [0, 2, 3],
        [4, 6, 5],
        [4, 7, 6],
        [0, 5, 1],
        [0, 4, 5],
        [1, 6, 2],
        [1, 5, 6],
        [2, 7, 3],
        [2, 6, 7],
        [3, 4, 0],
        [3, 7, 4],
    ];
    let post = Scan::new(mesh, ScanLandmarks::default()).unwrap();
    let error = post.fit(Figure::Mean).unwrap_err().to_string();
    assert!(error.contains("give its height as landmark"), "{error}");
    let marked = ScanLandmarks {
        crotch: Some(0.8),
        armpit: Some(1.3),
        ..ScanLandmarks::default()
    };
    let post = Scan::new(post.mesh().clone(), marked).unwrap();
    let error = post.fit(Figure::Mean).unwrap_err().to_string();
    assert!(error.contains("hold the arms off"), "{error}");
    // Landmarks that leave no trunk, or no arm.
    let own = Mannequin::new(&Figure::Woman.average(), Figure::Woman).unwrap();
    let with = |marks: ScanLandmarks| {
        let scan = Scan::new(own.skin().clone(), marks).unwrap();
        scan.fit(Figure::Woman).unwrap_err().to_string()
    };
    let error = with(ScanLandmarks {
        crotch: Some(1.25),
        ..ScanLandmarks::default()
    });
    assert!(error.contains("no trunk"), "{error}");
    let shoulder = own.skeleton().centre(Joint::LShoulder);
    let error = with(ScanLandmarks {
        wrist: Some(shoulder.into()),
        ..ScanLandmarks::default()
    });
    assert!(error.contains("landmark wrist"), "{error}");
}

#[test]
fn a_damaged_frame_is_refused() {
    let own = Mannequin::new(&Figure::Woman.average(), Figure::Woman).unwrap();
    let fit = Scan::new(own.skin().clone(), ScanLandmarks::default())
        .unwrap()
        .fit(Figure::Woman)
        .unwrap();
    let good = fit.description;
    type Spoil = fn(&mut Description);
    let spoils: [Spoil; 5] = [
        |d| d.frame.as_mut().unwrap().height = f64::NAN,
        |d| d.frame.as_mut().unwrap().crotch = 1.5,
        |d| d.frame.as_mut().unwrap().joints.elbow = d.frame.unwrap().joints.wrist,
        |d| d.frame.as_mut().unwrap().joints.shoulder[0] *= -1.0,
        |d| d.primitives[3].weight = 0.0,
    ];
    for spoil in spoils {
        let mut bad = good.clone();
        spoil(&mut bad);
        assert!(Mannequin::from_description(&bad).is_err());
    }
}
