#[path = "../examples/accuracy/extremes/mod.rs"]
mod extremes;
#[path = "../examples/scene/levels.rs"]
mod levels;
#[path = "../examples/accuracy/reference.rs"]
mod reference;
mod common;
use extremes::measure::*;
use extremes::problems::Extreme;
use common::kernels::KERNELS;

fn go<T: Measured>() {
    let t = std::time::Instant::now();
    let problems = problems::<T>(12);
    println!("{} problems {:?}", problems.len(), t.elapsed());
    let m = measure(&problems, &levels::levels());
    println!("{} {:?} gap {:e}  {:?}", m.precision, m.levels, m.gap, t.elapsed());
    for p in &problems {
        for k in 0..15 {
            let Some(proof) = p.proofs[k] else { continue };
            if proof.gap > 0.1 * proof.unit { 
                let a = p.input.answers()[k];
                println!("gap {:e} {:?} 1e{} {} exp {} mid {:e}\n  {:?}\n  {:?}", proof.gap / proof.unit, p.extreme, p.power, KERNELS[k], p.exponent, proof.middle.rounded(), a, p.input); }
        }
    }
    for (extreme, name, _) in Extreme::ALL {
        let of: Vec<_> = m.found.iter().filter(|f| f.extreme == extreme).collect();
        let worst = of.iter().map(|f| f.scalar).fold(0.0, f64::max);
        let lv: Vec<f64> = (0..m.levels.len()).map(|l| of.iter().filter_map(|f| f.levels.get(l).copied()).fold(0.0, f64::max)).collect();
        let at = of.iter().max_by(|a, b| a.scalar.total_cmp(&b.scalar)).unwrap();
        println!("{name:15} {:6} {worst:10.3} {} 1e{}  {lv:.3?}", of.len(), KERNELS[at.kernel], at.power);
    }
}
#[test]
fn probe() { go::<f64>(); go::<f32>(); }
