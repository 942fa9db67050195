//! The forms of Tables II and III on the GPU give the distances of the library.

use continuum_studies::gpu::{Form, GpuForms};
use continuum_testing::{Random, gpu};
use parry_continuum::distance::{Vec3, point_triangle, segment_segment};
use parry_continuum::gpu::Precision;

#[test]
fn clamps_and_trees_give_the_librarys_distances() {
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let tolerance = if precision == Precision::F32 { 1e-4 } else { 1e-10 };
        let mut random = Random::new(3);
        let mut point = || Vec3::from(random.point().to_array());
        let points: Vec<_> = (0..2000).map(|_| [point(), point(), point(), point()]).collect();
        for form in Form::ALL {
            let mut squared = Vec::new();
            GpuForms::new(gpu, form).unwrap().solve(&points, &mut squared).unwrap();
            assert_eq!(squared.len(), points.len());
            let mut wrong = 0;
            for (&[a, b, c, d], squared) in points.iter().zip(&squared) {
                let expected = match form {
                    Form::ClampedSegments | Form::TreeSegments => {
                        segment_segment([a, b], [c, d]).distance
                    }
                    Form::ClampedTriangle | Form::TreeTriangle => {
                        point_triangle(a, [b, c, d]).distance
                    }
                };
                wrong += usize::from((squared - expected * expected).abs() > tolerance);
            }
            // Neither form is exact for nearly parallel segments and thin triangles.
            assert!(wrong <= 2, "{name} {form:?}: {wrong}");
        }
    }
}
