//! A rehearsal of the program `gpu_speed` on the machine's GPU.

use continuum_programs::*;
use continuum_testing::gpu;
use parry_continuum::gpu::Precision;

#[test]
fn the_speed_of_the_gpu_is_measured_and_written() {
    let gpu_speed = env!("CARGO_BIN_EXE_gpu_speed");
    let _ = std::fs::remove_dir_all(place("gpu_speed"));
    let arguments = [
        ["--largest", "1000"],
        ["--robots", "20"],
        ["--problems", "20"],
        ["--enough", "0"],
        ["--out", "gpu_speed"],
    ];
    let arguments = arguments.as_flattened();
    if gpu::open(Precision::F32).is_none() {
        refuse(gpu_speed, arguments, "adapter");
        return;
    }
    succeed(gpu_speed, arguments);
    let page = read("gpu_speed/GPU_SPEED.md");
    assert_finite(&page);
    let precisions = if gpu::open(Precision::F64).is_some() { 2 } else { 1 };
    for head in [
        "| triangles | search, first time |",
        "| triangles | search | GPU f32 |",
        "| triangles | search | exhaustive f32, CPU |",
    ] {
        assert_eq!(table(&page, head).len(), 1, "{head}: {page}");
    }
    // Three questions; the work for two models.
    for (head, rows) in
        [("| triangles | question | robots |", 3), ("| triangles | model | question | nodes |", 6)]
    {
        assert_eq!(table(&page, head).len(), rows, "{head}: {page}");
    }
    let studies = read("gpu_speed/internals/gpu_studies.md");
    assert_finite(&studies);
    for (head, rows) in [
        ("| triangles | precision | capsules, device |", precisions),
        ("| triangles | precision | discs |", 3 * precisions),
        ("| distance | precision | clamps, device |", 2 * precisions),
        // Four finders at three degrees; the closed form solves only the first degree.
        ("| degree | finder |", 4 + 3 + 3),
    ] {
        assert_eq!(table(&studies, head).len(), rows, "{head}: {studies}");
    }
    let rows = |file: &str| read(file).lines().count() - 1;
    assert_eq!(rows("gpu_speed/internals/gpu_every_pair.csv"), 3 * precisions);
    // Of seven degrees.
    assert_eq!(rows("gpu_speed/internals/gpu_roots.csv"), 4 * 7 - 4);
    // To the last bit.
    assert_eq!(
        studies.matches(": the distances are the search's, and ").count(),
        precisions,
        "{studies}"
    );

    let adapter = gpu::open(Precision::F32).unwrap().adapter();
    if adapter.is_software {
        assert!(page.contains("This is a GPU in software"), "{page}");
        refuse(gpu_speed, arguments, "choose another --out");
        let _ = std::fs::remove_dir_all(place("gpu_speed_alone"));
        let elsewhere = ["--out", "gpu_speed_alone", "--without-studies"];
        succeed(gpu_speed, &[&arguments[..8], &elsewhere].concat());
        assert_eq!(std::fs::read_dir(place("gpu_speed_alone")).unwrap().count(), 1);
    }
    refuse(gpu_speed, &["--tflops", "1"], "66.9,33.5");
}
