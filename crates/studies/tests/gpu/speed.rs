//! The program `gpu_speed`, rehearsed on whatever GPU there is.

use continuum_testing::gpu;
use continuum_testing::programs::*;
use parry_continuum::gpu::Precision;

#[test]
fn the_speed_of_the_gpu_is_measured_and_written() {
    let gpu_speed = env!("CARGO_BIN_EXE_gpu_speed");
    let _ = std::fs::remove_dir_all(place("gpu_speed"));
    let arguments = ["--largest", "1000", "--problems", "20", "--enough", "0", "--out", "gpu_speed"];
    if gpu::open(Precision::F32).is_none() {
        refuse(gpu_speed, &arguments, "adapter");
        return;
    }
    succeed(gpu_speed, &arguments);
    let page = read("gpu_speed/GPU_SPEED.md");
    assert_finite(&page);
    let precisions = if gpu::open(Precision::F64).is_some() { 2 } else { 1 };
    for (head, rows) in [
        ("| triangles | search, first time |", 1),
        ("| triangles | search | GPU f32 |", 1),
        ("| triangles | search | exhaustive f32, CPU |", 1),
        ("| triangles | precision | capsules, device |", precisions),
        ("| triangles | precision | discs |", 3 * precisions),
        ("| distance | precision | clamps, device |", 2 * precisions),
        // Four finders at three degrees, of which the closed form solves the first.
        ("| degree | finder |", 4 + 3 + 3),
    ] {
        assert_eq!(table(&page, head).len(), rows, "{head}: {page}");
    }
    let rows = |file: &str| read(file).lines().count() - 1;
    assert_eq!(rows("gpu_speed/gpu_every_pair.csv"), 3 * precisions);
    // Of seven degrees.
    assert_eq!(rows("gpu_speed/gpu_roots.csv"), 4 * 7 - 4);
    // The distances are those of the search.
    let check = page.lines().filter(|line| line.starts_with("- 1000 triangles,"));
    let errors: Vec<f64> = check
        .map(|line| line.split(" at most ").nth(1).unwrap().split(" mm").next().unwrap().parse().unwrap())
        .collect();
    assert!(errors.len() == precisions && errors.iter().all(|error| *error < 1e-10), "{page}");

    let adapter = gpu::open(Precision::F32).unwrap().adapter();
    if adapter.is_software {
        assert!(page.contains("This is a GPU in software"), "{page}");
        refuse(gpu_speed, &arguments, "choose another --out");
    }
    refuse(gpu_speed, &["--tflops", "1"], "66.9,33.5");
}
