use parry_continuum::parry::math::*;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::*;
use parry_continuum::*;
#[test]
fn zz() {
    let v = Vector::new;
    let robot = Chain::cylinders(&[v(-1.0, -1.0, 1024.0), v(3.0, 1.0000000000000002, 0.5)], &[70368744177664.0]).unwrap();
    let p = v(0.5, 0.5, 5.764607523034235e17);
    let mesh = TriMesh::new(vec![p, Vector::ZERO, Vector::ZERO], vec![[0, 0, 0]; 9]).unwrap();
    let mut out = vec![];
    let mut e = Exhaustive::<f64>::new(&mesh).unwrap();
    e.per_link(&robot, &Pose::IDENTITY, &mut out).unwrap();
    let d = out[0].distance;
    println!("{:x} {:?}", d.to_bits(), out);
    println!("{:?}", out[0].certify(&robot, &Pose::IDENTITY, &mesh));
    println!("{:x}", e.minimum(&robot, &Pose::IDENTITY).unwrap().distance.to_bits());
    for k in -3i64..4 {
        let m = f64::from_bits((d.to_bits() as i64 + k) as u64);
        println!("{k} {:?} {:?}", e.clears(&robot, &Pose::IDENTITY, m), BvhSearch::new(&mesh).unwrap().clears(&robot, &Pose::IDENTITY, m));
    }
}
