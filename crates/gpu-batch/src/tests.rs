//! Batches, and devices that fail. Without a GPU these tests pass without doing anything, unless
//! PARRY_CONTINUUM_REQUIRE_GPU is set.

use crate::arithmetic::{self, OPERANDS};
use crate::{
    Adapter, Batch, Binding, Device, DeviceError, DeviceFailure, Kernel, Precision, Shader, wgsl,
};
use std::sync::OnceLock;

/// The GPU of this machine in a precision, if there is one.
fn device(precision: Precision) -> Option<&'static Device> {
    static SINGLE: OnceLock<Option<Device>> = OnceLock::new();
    static DOUBLE: OnceLock<Option<Device>> = OnceLock::new();
    let opened = if precision == Precision::F32 { &SINGLE } else { &DOUBLE };
    let open = || match Device::open(precision) {
        Ok(device) => Some(device),
        Err(error) => {
            assert!(std::env::var_os("PARRY_CONTINUUM_REQUIRE_GPU").is_none(), "{error}");
            None
        }
    };
    opened.get_or_init(open).as_ref()
}

/// A kernel that answers a number with itself.
const ECHO: Kernel = Kernel::new(
    "echo",
    "fn solve(problem: u32, answer: u32) { answers[answer] = problems[problem]; }",
    1,
    1,
);

/// A kernel that writes nothing.
fn idle() -> Shader {
    Shader::new("idle", "@compute @workgroup_size(1) fn idle() {}")
}

#[test]
fn whole_problems_are_answered_in_any_number() {
    let text = "fn solve(problem: u32, answer: u32) { answers[answer] = problems[problem] + problems[problem + 1u]; }";
    for precision in [Precision::F32, Precision::F64] {
        let Some(device) = device(precision) else { continue };
        let mut batch = Batch::new(device, &Kernel::new("sum", text, 2, 1)).unwrap();
        for count in [0, 1, 2, 5, 1000, 100_001] {
            let mut answers = Vec::new();
            batch
                .run((0..count).map(f64::from), |answer| answers.extend_from_slice(answer))
                .unwrap();
            let expected: Vec<_> = (0..count / 2).map(|k| f64::from(4 * k + 1)).collect();
            assert_eq!(answers, expected);
        }
    }
}

/// The functions of the prelude, where they have an edge.
#[test]
fn what_kernels_build_on_is_as_it_is_said_to_be() {
    let text = "fn solve(problem: u32, answer: u32) {
        let x = problems[problem];
        answers[answer] = over(real(1.0), x);
        answers[answer + 1u] = cbrt_estimate(x);
        answers[answer + 2u] = x * power_of_two_to_unity(x);
        answers[answer + 3u] = real(from_below(x));
        answers[answer + 4u] = real(from_above(x));
        answers[answer + 5u] = UNIT_ROUNDOFF;
    }";
    for precision in [Precision::F32, Precision::F64] {
        let Some(device) = device(precision) else { continue };
        let mut batch = Batch::new(device, &Kernel::new("prelude", text, 1, 6)).unwrap();
        let numbers = [1.0, 3.0, 0.1, 1e-9, 12_345.678, 1e20, 0.0, -2.0];
        let mut answers = Vec::new();
        batch.run(numbers, |answer| answers.push(answer.to_vec())).unwrap();
        for (x, answer) in numbers.into_iter().zip(&answers) {
            let x = if precision == Precision::F32 { f64::from(x as f32) } else { x };
            let quotient = if x > 0.0 { 1.0 / x } else { 0.0 };
            assert!((answer[0] - quotient).abs() <= 1e-6 * quotient, "1 / {x}: {answer:?}");
            if x != 0.0 {
                assert!(
                    (answer[1] / x.abs().cbrt() - 1.0).abs() < 0.05,
                    "the cube root of {x}: {answer:?}"
                );
                let squared = answer[2] * answer[2];
                assert!((1e-300..1e300).contains(&squared), "{x} near one: {answer:?}");
            }
            if x >= 0.0 {
                assert!(answer[3] <= x && x <= answer[4], "{x} between: {answer:?}");
                assert!(answer[4] - answer[3] <= 1e-6 * x, "{x} between: {answer:?}");
            }
            let unit =
                if precision == Precision::F32 { f64::from(f32::EPSILON) } else { f64::EPSILON };
            assert_eq!(answer[5], unit / 2.0);
        }
    }
}

/// An answer that an earlier submission wrote is none.
#[test]
fn an_earlier_answer_is_no_answer() {
    let Some(device) = device(Precision::F32) else { return };
    let mut batch = Batch::new(device, &ECHO).unwrap();
    let mut answers = Vec::new();
    batch.run([1.0, 2.0, 3.0], |answer| answers.extend_from_slice(answer)).unwrap();
    batch.run([4.0, 5.0, 6.0], |answer| answers.extend_from_slice(answer)).unwrap();
    assert_eq!(answers, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    batch.kernel = device.compile("idle", &idle(), &batch.layout, &[]).unwrap();
    assert_eq!(batch.run([7.0, 8.0, 9.0], |_| panic!("an answer")), Err(DeviceFailure::Unanswered));
}

/// A driver does not name the command: every user of the device gets the failure, once.
#[test]
fn a_refused_command_is_an_error_of_every_batch_once() {
    if device(Precision::F32).is_none() {
        return;
    }
    let device = Device::open(Precision::F32).unwrap();
    let mut batches = [(); 2].map(|()| Batch::new(&device, &ECHO).unwrap());
    // What no device can do.
    device.buffer(u64::MAX / 4, wgpu::BufferUsages::STORAGE);
    for batch in &mut batches {
        let failure = batch.run([1.0], |_| {}).unwrap_err();
        assert!(
            matches!(failure, DeviceFailure::Refused | DeviceFailure::OutOfMemory),
            "{failure}"
        );
        assert_eq!(batch.run([1.0], |_| {}), Ok(()));
    }
}

#[test]
fn a_lost_device_is_an_error_of_every_batch_for_ever() {
    if device(Precision::F32).is_none() {
        return;
    }
    let device = Device::open(Precision::F32).unwrap();
    let mut batch = Batch::new(&device, &ECHO).unwrap();
    batch.run([1.0], |_| {}).unwrap();
    device.raw().destroy();
    for _ in 0..2 {
        assert_eq!(batch.run([1.0], |_| panic!("an answer")), Err(DeviceFailure::Lost));
    }
}

#[test]
fn a_shader_that_does_not_compile_is_an_error() {
    let Some(device) = device(Precision::F32) else { return };
    let layout = device.layout(&[Binding::Read, Binding::Write]);
    let kernel = Shader::new("nonsense", "@compute fn nonsense() { return 1; }");
    match device.compile("nonsense", &kernel, &layout, &[]) {
        Err(DeviceError::Shader { kernel, .. }) if kernel == "nonsense" => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_machine_without_a_gpu_is_an_error() {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::empty();
    match Device::open_of(descriptor, Precision::F32).err() {
        Some(error @ DeviceError::NoAdapter { .. }) => {
            assert!(error.to_string().contains("install a driver"), "{error}");
        }
        other => panic!("{other:?}"),
    }
}

/// Quotients and roots as a device in single precision gives them.
#[test]
fn single_precision_does_not_pass_for_double() {
    let adapter = Adapter { name: "a".into(), interface: "b".into(), is_software: true };
    let results = OPERANDS.iter().flat_map(|&[x, y]| [x / y, x.sqrt()]);
    let exact: Vec<_> = results.collect();
    let rounded: Vec<_> = exact.iter().map(|&value| f64::from(value as f32)).collect();
    let nothing = vec![f64::NAN; exact.len()];
    assert_eq!(arithmetic::compare(&exact, Precision::F64, &adapter), Ok(()));
    assert_eq!(arithmetic::compare(&rounded, Precision::F32, &adapter), Ok(()));
    for wrong in [rounded, nothing] {
        let error = arithmetic::compare(&wrong, Precision::F64, &adapter).unwrap_err();
        assert!(error.to_string().contains("use Precision::F32"), "{error}");
    }
    assert_eq!(adapter.to_string(), "a (b, in software)");
}

/// What Rust says of a record's size, WGSL says too.
#[test]
fn records_are_as_large_as_shaders_see_them() {
    crate::record! {
        struct Mixed {
            one: u32,
            number: f64,
            point: [f64; 3],
            other: u32,
            last: f64,
        }
    }
    use crate::Record;
    for precision in [Precision::F32, Precision::F64] {
        let text = wgsl::prelude(precision) + &Mixed::wgsl();
        let module = wgpu::naga::front::wgsl::parse_str(&text).unwrap();
        let mut layouter = wgpu::naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).unwrap();
        let (handle, _) =
            module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(Mixed::NAME)).unwrap();
        assert_eq!(u64::from(layouter[handle].size), Mixed::size(precision), "{precision:?}");
    }
}
