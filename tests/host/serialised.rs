//! Links, chains and answers come back as they were, and what no constructor would make does not come back.

use crate::draw::Draw;
use crate::scene::tube;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Certificate, LinkProximity, Proximity, Work};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
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
    let link =
        json!({"start": [0.0, 0.0, 0.0], "end": [1.0, 0.0, 0.0], "radius": 0.5, "caps": ["Flat", "Round"]});
    let with = |key: &str, value: Value| {
        let mut link = link.clone();
        link[key] = value;
        refusal::<ModifiedCylinder>(link)
    };
    assert_eq!(with("radius", json!(0.25)), "");
    assert!(with("radius", json!(-1.0)).contains("a radius must be finite, at least 0"));
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
    assert!(with("radii", json!([0.5, -0.4])).contains("radius 1 is -0.4"));
    assert!(with("points", json!([])).contains("at least 2 points"));
    assert!(with("points", json!([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])).contains("link 0"));
    assert!(with("caps", json!([])).contains("as many caps"));
    assert!(with("segments", json!([1, 0])).contains("link 1 stands for 0"));
    assert!(with("segments", json!([1, u64::MAX])).contains("link 1 stands for"));

    let answer = json!({"link": 0, "triangle": 1, "distance": 0.5, "on_robot": [0.0, 0.0, 0.0], "on_mesh": [0.0, 0.0, 0.5]});
    let mut negative = answer.clone();
    negative["distance"] = json!(-0.5);
    assert_eq!(refusal::<LinkProximity>(answer), "");
    assert!(refusal::<LinkProximity>(negative).contains("the distance is -0.5"));

    let bounds = |lower: f64, upper: f64| refusal::<Certificate>(json!({"lower": lower, "upper": upper}));
    assert_eq!(bounds(0.0, 0.5), "");
    assert!(bounds(0.5, 0.25).contains("0.5 to 0.25 bounds no distance"));
    assert!(bounds(-0.5, 0.25).contains("bounds no distance"));
    assert!(refusal::<Work>(json!({"nodes": 1, "visited": -1})).contains("-1"));
}
