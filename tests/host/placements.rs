//! What the queries say of aligned and touching placements fits together, for every pair of the dispatcher's table, in
//! both orders. What `distance` says is held against parry's shapes elsewhere (see [`pairs`](super::pairs)).

use continuum_testing::Random;
use continuum_testing::placements::{Placement, Touch, Wall};
use parry_continuum::ContinuumDispatcher;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::parry::query::*;
use parry_continuum::parry::shape::Shape;
use std::collections::BTreeMap;

/// What rounding leaves where an answer is exact, and what GJK leaves for shapes of size one.
fn tolerance(kind: Wall) -> Real {
    match kind {
        Wall::Cuboid
        | Wall::Capsule
        | Wall::Cylinder
        | Wall::Cone
        | Wall::ConvexPolyhedron
        | Wall::Link
        | Wall::Chain
        | Wall::Compound
        | Wall::Voxels => 1e-5,
        _ => 1e-11,
    }
}

const PREDICTIONS: [Real; 9] = [-0.2, -1e-3, -1e-9, 0.0, 1e-12, 1e-6, 0.02, 0.5, Real::INFINITY];

fn count() -> usize {
    std::env::var("COUNT").map_or(300, |c| c.parse().unwrap())
}

#[test]
fn explore() {
    let mut worst: BTreeMap<String, (usize, String)> = BTreeMap::new();
    let d = ContinuumDispatcher::default();
    for kind in Wall::ALL {
        let mut random = Random::new(301);
        for _ in 0..count() {
            let p = random.placement(kind);
            for (first, pos12, g1, g2) in
                [(true, p.pose, &*p.robot, &*p.wall), (false, p.pose.inverse(), &*p.wall, &*p.robot)]
            {
                let tol = tolerance(kind);
                let mut fail = |what: String, say: String| {
                    let e = worst.entry(format!("{kind:?} {what}")).or_insert((0, String::new()));
                    e.0 += 1;
                    if e.0 == 1 {
                        e.1 = format!(
                            "{say} {first} {:?} gap {:e} tilt {:e} {:?} {:?} {pos12:?}",
                            p.touch,
                            p.gap,
                            p.tilt,
                            p.robot.as_typed_shape(),
                            p.wall.as_typed_shape()
                        )
                    }
                };
                *&mut fail("asked".into(), String::new());
                let dist = d.distance(&pos12, g1, g2).map(|x| x.distance);
                let inter = d.intersection_test(&pos12, g1, g2).map(|x| x.intersecting);
                let closest = d.closest_points(&pos12, g1, g2, Real::MAX);
                let contact = d.contact(&pos12, g1, g2, Real::MAX);
                if let (Ok(dist), Ok(inter)) = (dist, inter) {
                    if inter && dist > tol {
                        fail("meets, apart".into(), format!("{dist:e}"))
                    }
                    if !inter && dist == 0.0 {
                        fail("apart, meets".into(), String::new())
                    }
                    match closest {
                        Err(_) => {}
                        Ok(ClosestPoints::Intersecting) => {
                            if dist > tol {
                                fail("closest meets".into(), format!("{dist:e}"))
                            }
                        }
                        Ok(ClosestPoints::Disjoint) => fail("closest none".into(), format!("{dist:e}")),
                        Ok(ClosestPoints::WithinMargin(a, b)) => {
                            let l = (a - pos12 * b).length();
                            if (l - dist).abs() > tol {
                                fail("closest differs".into(), format!("{l:e} {dist:e}"))
                            }
                        }
                    }
                    match contact {
                        Err(_) => {}
                        Ok(None) => fail("contact none".into(), format!("{dist:e}")),
                        Ok(Some(c)) => {
                            if dist > tol && (c.dist - dist).abs() > tol {
                                fail("contact differs".into(), format!("{:e} {dist:e}", c.dist))
                            }
                            if dist <= tol && c.dist > tol {
                                fail("contact apart".into(), format!("{:e} {dist:e}", c.dist))
                            }
                            let between = c.point1 - pos12 * c.point2;
                            if (between + c.normal1 * c.dist).length() > 10.0 * tol {
                                fail(
                                    "contact points".into(),
                                    format!("{:e} {:e}", c.dist, (between + c.normal1 * c.dist).length()),
                                )
                            }
                        }
                    }
                }
                for pr in PREDICTIONS {
                    let within = d.contact(&pos12, g1, g2, pr);
                    let full = contact.ok().flatten();
                    if let Ok(w) = within {
                        if w.is_some_and(|w| w.dist > pr) {
                            fail(format!("beyond {}", pr < 0.0), format!("{pr} {w:?}"))
                        }
                        if let (Some(w), Some(f)) = (w, full) {
                            if (w.dist - f.dist).abs() > tol {
                                fail("prediction matters".into(), format!("{pr} {:e} {:e}", w.dist, f.dist))
                            }
                        }
                        if let (None, Some(f)) = (w, full) {
                            if f.dist < pr - tol {
                                fail("prediction loses".into(), format!("{pr} {:e}", f.dist))
                            }
                        }
                    }
                    if let (Ok(dist), Ok(c)) = (dist, d.closest_points(&pos12, g1, g2, pr)) {
                        match c {
                            ClosestPoints::Intersecting => {
                                if dist > tol {
                                    fail("closest meets p".into(), format!("{pr} {dist:e}"))
                                }
                            }
                            ClosestPoints::Disjoint => {
                                if dist < pr - tol || dist == 0.0 && pr >= 0.0 {
                                    fail("closest loses".into(), format!("{pr} {dist:e}"))
                                }
                            }
                            ClosestPoints::WithinMargin(a, b) => {
                                let l = (a - pos12 * b).length();
                                if l > pr + tol || (l - dist).abs() > tol {
                                    fail("closest beyond".into(), format!("{pr} {l:e} {dist:e}"))
                                }
                            }
                        }
                    }
                    if pr > 1.0 {
                        continue;
                    }
                    let (mut manifolds, mut workspace): (Vec<ContactManifold<(), ()>>, _) = (vec![], None);
                    let mut ok = true;
                    for _ in 0..2 {
                        ok &= d.contact_manifolds(&pos12, g1, g2, pr, &mut manifolds, &mut workspace).is_ok();
                    }
                    if !ok {
                        fail("no manifolds".into(), String::new());
                        continue;
                    }
                    let least = manifolds
                        .iter()
                        .flat_map(|m| m.points.iter().map(|p| p.dist))
                        .fold(Real::INFINITY, Real::min);
                    let Ok(w) = within else { continue };
                    let constrained = p.wall.as_trimesh().is_some_and(|m| m.flags().bits() != 0);
                    match w {
                        None => {
                            if least <= pr - tol {
                                fail(format!("manifold extra {}", pr < 0.0), format!("{pr:e} {least:e}"))
                            } else if least < Real::INFINITY && least > pr + tol {
                                fail(format!("manifold beyond {}", pr < 0.0), format!("{pr:e} {least:e}"))
                            }
                        }
                        Some(w) if w.dist > pr - tol => {}
                        Some(w) => {
                            if least == Real::INFINITY {
                                fail(format!("manifold none {constrained}"), format!("{pr:e} {:e}", w.dist))
                            } else if least > w.dist + tol {
                                fail(
                                    format!("manifold far {constrained}"),
                                    format!("{pr:e} {least:e} {:e}", w.dist),
                                )
                            } else if least < w.dist - tol {
                                fail(
                                    format!("manifold deep {constrained}"),
                                    format!("{pr:e} {least:e} {:e}", w.dist),
                                )
                            }
                        }
                    }
                }
            }
        }
    }
    for (what, (n, say)) in &worst {
        println!("{n:6} {what}");
        if std::env::var("SAY").is_ok() {
            println!("      {say}");
        }
    }
}
