//! Links, chains and answers come back as they were, and what no constructor would make does not
//! come back.

use crate::draw::Draw;
use crate::scene::tube;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{
    BvhSearch, Certificate, Clearance, Decision, LinkProximity, MotionAnswer, Proximity,
    RobotMotionAnswer, RobotPair, Work,
};
use parry_continuum::{Cap, Chain, LinearMotion, ModifiedCylinder, Tube};
use serde_json::{Value, from_str, from_value, json, to_string, to_value};

#[test]
fn what_is_written_is_read() {
    let mut random = Random::new(91);
    for _ in 0..100 {
        let link = random.link();
        assert_eq!(from_str::<ModifiedCylinder>(&to_string(&link).unwrap()).unwrap(), link);
        let chain = tube(&mut random);
        let read: Chain = from_str(&to_string(&chain).unwrap()).unwrap();
        assert_eq!(read, chain);
        let (vertices, triangles) = Ball::new(9.0).to_trimesh(9, 9);
        let mesh = TriMesh::new(vertices, triangles).unwrap();
        let mut search = BvhSearch::new(&mesh).unwrap();
        let found = search.minimum(&read, &Pose::IDENTITY).unwrap();
        assert_eq!(from_str::<LinkProximity>(&to_string(&found).unwrap()).unwrap(), found);
        let proof = found.certify(&read, &Pose::IDENTITY, &mesh).unwrap();
        assert_eq!(from_str::<Certificate>(&to_string(&proof).unwrap()).unwrap(), proof);
        let work = search.work();
        assert!(work.nodes > 0);
        assert_eq!(from_str::<Work>(&to_string(&work).unwrap()).unwrap(), work);
    }
    assert_eq!(to_value(Cap::Flat).unwrap(), json!("Flat"));
}

/// Repeated points leave a link that stands for more than one segment.
#[test]
fn a_chain_keeps_its_segments() {
    let points = [Vector::ZERO, Vector::ZERO, Vector::X, Vector::X, 2.0 * Vector::X];
    let chain = Chain::from_centreline(&points, &[0.5; 4]).unwrap();
    let read: Chain = from_str(&to_string(&chain).unwrap()).unwrap();
    assert_eq!((read.segments_of(0), read.segments_of(1)), (0..3, 3..4));
    assert_eq!(read, chain);
}

fn refusal<T: serde::de::DeserializeOwned>(value: Value) -> String {
    from_value::<T>(value).err().map(|error| error.to_string()).unwrap_or_default()
}

#[test]
fn what_no_constructor_makes_is_an_error() {
    let link = json!({"start": [0.0, 0.0, 0.0], "end": [1.0, 0.0, 0.0], "radius": 0.5, "caps": ["Flat", "Round"]});
    let with = |key: &str, value: Value| {
        let mut link = link.clone();
        link[key] = value;
        refusal::<ModifiedCylinder>(link)
    };
    assert_eq!(with("radius", json!(0.25)), "");
    assert!(
        with("radius", json!(-1.0)).contains("radius 0 is -1; `radius` must be finite, at least 0")
    );
    assert!(with("end", json!([0.0, 0.0, 0.0])).contains("length 0"));
    assert!(with("end", json!([1e200, 0.0, 0.0])).contains("beyond"));
    assert!(with("caps", json!(["Flat", "Square"])).contains("Square"));

    let chain = json!({
        "points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 1.0, 0.0]],
        "radii": [0.5, 0.4], "caps": [["Flat", "Flat"], ["Flat", "Round"]], "segments": [1, 2],
    });
    let with = |key: &str, value: Value| {
        let mut chain = chain.clone();
        chain[key] = value;
        refusal::<Chain>(chain)
    };
    assert_eq!(with("radii", json!([0.5, 0.5])), "");
    assert!(with("radii", json!([0.5])).contains("2 radii, got 1"));
    assert!(
        with("radii", json!([0.5, -0.4]))
            .contains("radius 1 is -0.4; `radii` must be finite, at least 0")
    );
    assert!(with("points", json!([])).contains("at least 2 points"));
    assert!(
        with("points", json!([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
            .contains("link 0")
    );
    assert!(with("caps", json!([])).contains("as many caps"));
    assert!(with("segments", json!([1, 0])).contains("link 1 stands for 0"));
    assert!(with("segments", json!([1, u64::MAX])).contains("link 1 stands for"));

    let answer = json!({
        "link": 0, "triangle": 1, "distance": 0.5, "arc_length": 2.0, "segment": 3,
        "on_robot": [0.0, 0.0, 0.0], "on_mesh": [0.0, 0.0, 0.5],
    });
    let mut negative = answer.clone();
    negative["distance"] = json!(-0.5);
    assert_eq!(refusal::<LinkProximity>(answer), "");
    assert!(refusal::<LinkProximity>(negative).contains("the distance is -0.5"));

    let bounds =
        |lower: f64, upper: f64| refusal::<Certificate>(json!({"lower": lower, "upper": upper}));
    assert_eq!(bounds(0.0, 0.5), "");
    assert!(bounds(0.5, 0.25).contains("0.5 to 0.25 bounds no distance"));
    assert!(bounds(-0.5, 0.25).contains("bounds no distance"));
    assert!(refusal::<Work>(json!({"nodes": 1, "visited": -1})).contains("-1"));
}

/// Of every kind of answer about a tube and about a motion.
#[test]
fn answers_about_tubes_and_motions_come_back() {
    let (vertices, triangles) = Ball::new(9.0).to_trimesh(32, 32);
    let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles).unwrap()).unwrap();
    let points = [Vector::ZERO, Vector::Z, Vector::new(0.3, 0.0, 2.0)];
    let tube = Tube::from(&Chain::from_centreline(&points, &[0.5; 2]).unwrap());
    let found = search.clearance(&tube, &Pose::IDENTITY, 0.01).unwrap();
    assert_eq!(from_str::<Clearance>(&to_string(&found).unwrap()).unwrap(), found);
    for decision in [Decision::Clear, Decision::Contact, Decision::Undecided] {
        assert_eq!(from_str::<Decision>(&to_string(&decision).unwrap()).unwrap(), decision);
    }

    // Out of the ball, and along a floor at almost exactly the margin, which is undecided.
    let corners = [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vector::new(x, y, -2.0));
    let mut floor =
        BvhSearch::new(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap();
    let least = floor
        .minimum(&Chain::from_centreline(&points, &[0.5; 2]).unwrap(), &Pose::IDENTITY)
        .unwrap();
    let mut kinds = [0; 6];
    for step in 1..60 {
        let shift = Vector::new(0.05, 0.02, 0.15) * f64::from(step);
        for (search, shift, margin) in [
            (&mut search, shift, 0.5),
            (&mut floor, shift.with_z(0.0), least.distance * (1.0 - 1e-15)),
        ] {
            let to = points.map(|point| point + shift);
            let motion = LinearMotion::chain(&points, &to, &[0.5; 2]).unwrap();
            let answer = search.clears_motion(&motion, margin, 0.1).unwrap();
            assert_eq!(from_str::<MotionAnswer>(&to_string(&answer).unwrap()).unwrap(), answer);
            kinds[answer.decision as usize] += 1;
            let answer = search.time_of_contact(&motion, margin, 0.1).unwrap();
            assert_eq!(from_str::<MotionAnswer>(&to_string(&answer).unwrap()).unwrap(), answer);
            kinds[3 + answer.decision as usize] += 1;
        }
    }
    assert!(kinds.iter().all(|count| *count > 10), "{kinds:?}");
}

#[test]
fn what_no_query_about_a_motion_answers_is_an_error() {
    let contact = json!({
        "t": 0.5, "upper": 0.25, "arc_length": 3.0, "segment": 2, "section": 0, "triangle": 7,
        "on_robot": [0.0, 0.0, 0.0], "on_mesh": [0.0, 0.0, 0.25],
    });
    let answer = |decision: &str, interval: [f64; 2], contact: Option<&Value>| {
        let mut answer = json!({"decision": decision, "interval": interval, "contact": contact});
        if decision == "Undecided" {
            answer["reason"] = json!("Work");
        }
        refusal::<MotionAnswer>(answer)
    };
    let unexplained = json!({"decision": "Undecided", "interval": [0.25, 0.5], "contact": null});
    assert!(refusal::<MotionAnswer>(unexplained).contains("the reason is None"));
    let with = |key: &str, value: Value| {
        let mut contact = contact.clone();
        contact[key] = value;
        answer("Contact", [0.0, 0.5], Some(&contact))
    };
    assert_eq!(with("t", json!(1.0)), "");
    assert!(with("t", json!(1.5)).contains("from 0 to 1"));
    assert!(with("t", json!(-0.5)).contains("from 0 to 1"));
    assert!(with("upper", json!(-0.25)).contains("the clearance is -0.25"));
    assert!(with("on_mesh", json!([0.0, 0.0])).contains("length"));
    assert_eq!(answer("Contact", [0.5, 0.5], Some(&contact)), "");
    assert!(answer("Contact", [0.75, 0.5], Some(&contact)).contains("in order, not 0.75 to 0.5"));
    assert!(answer("Contact", [0.5, 0.5], None).contains("the contact is None"));
    assert!(answer("Clear", [1.0, 1.0], Some(&contact)).contains("the decision is Clear"));
    assert_eq!(answer("Undecided", [0.25, 0.5], None), "");
    assert!(answer("Undecided", [0.5, 0.25], None).contains("in order"));
    assert_eq!(answer("Clear", [1.0, 1.0], None), "");
}

#[test]
fn answers_about_two_motions_come_back_and_no_others() {
    let needle = |x: f64| [Vector::new(x, 0.0, 0.0), Vector::new(x, 0.0, 4.0)];
    let at_rest = LinearMotion::chain(&needle(0.0), &needle(0.0), &[0.5]).unwrap();
    let passing = LinearMotion::chain(&needle(-9.0), &needle(9.0), &[0.5]).unwrap();
    let clear = LinearMotion::chain(&needle(9.0), &needle(7.0), &[0.5]).unwrap();
    let mut pair = RobotPair::new();
    let [touched, free] =
        [&passing, &clear].map(|other| pair.clears_motions(&at_rest, other, 1.0, 1e-3).unwrap());
    assert!(touched.contact.is_some() && free.is_clear());
    for answer in [touched, free] {
        assert_eq!(from_str::<RobotMotionAnswer>(&to_string(&answer).unwrap()).unwrap(), answer);
    }

    let written = to_value(touched).unwrap();
    let with = |change: &dyn Fn(&mut Value)| {
        let mut answer = written.clone();
        change(&mut answer);
        refusal::<RobotMotionAnswer>(answer)
    };
    assert_eq!(with(&|_| ()), "");
    assert!(with(&|answer| answer["contact"]["t"] = json!(1.5)).contains("from 0 to 1"));
    assert!(
        with(&|answer| answer["contact"]["upper"] = json!(-0.25))
            .contains("the clearance is -0.25")
    );
    assert!(with(&|answer| answer["contact"]["on_first"] = json!([0.0, 0.0])).contains("length"));
    assert!(
        with(&|answer| answer["interval"] = json!([0.75, 0.5]))
            .contains("in order, not 0.75 to 0.5")
    );
    assert!(with(&|answer| answer["contact"] = Value::Null).contains("the contact is None"));
    assert!(with(&|answer| answer["decision"] = json!("Clear")).contains("the decision is Clear"));
}
