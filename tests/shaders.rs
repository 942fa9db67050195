//! Every shader, on machines without a GPU: it is valid in both precisions and translates to what drivers take, and it
//! keeps the rules that no driver checks.

#[path = "../src/gpu/shaders.rs"]
mod shaders;

use naga::back::{PipelineConstants, hlsl, msl, pipeline_constants::process_overrides, spv};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Expression, MathFunction, Module, ShaderStage};
use shaders::{KERNELS, Kernel, QUARTIC, REAL_F32, REAL_F64};

const PRECISIONS: [(&str, &str, bool); 2] = [("f32", REAL_F32, false), ("f64", REAL_F64, true)];

/// The kernel's module in a precision.
fn module(kernel: &Kernel, real: &str, double: bool) -> (Module, ModuleInfo) {
    // Of any degree; the last one is that which the others of a test look at.
    let mut modules = [2, 16, QUARTIC].map(|coefficients| {
        let text = kernel.source(real, coefficients);
        let module = naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}: {}", kernel.name, error.emit_to_string(&text)));
        let info = validate(kernel.name, &module, double);
        (module, info)
    });
    std::mem::take(&mut modules[2])
}

fn validate(name: &str, module: &Module, double: bool) -> ModuleInfo {
    let capabilities = if double { Capabilities::FLOAT64 } else { Capabilities::empty() };
    Validator::new(ValidationFlags::all(), capabilities)
        .validate(module)
        .unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

/// Every value that the kernel's overrides are given, one choice at a time.
fn choices(module: &Module) -> Vec<PipelineConstants> {
    let mut choices = vec![PipelineConstants::default()];
    for (_, constant) in module.overrides.iter() {
        let name = constant.name.clone().expect("a named override");
        let largest = match name.as_str() {
            "CULLING" | "COMPANION" => 1,
            "FORM" => 3,
            "PAIR" => 9,
            other => panic!("how far does {other} go?"),
        };
        for value in 0..=largest {
            choices.push([(name.clone(), f64::from(value))].into_iter().collect());
        }
    }
    choices
}

#[test]
fn every_kernel_translates() {
    let mut translated = 0;
    for kernel in KERNELS {
        for (precision, real, double) in PRECISIONS {
            let (module, info) = module(kernel, real, double);
            let entry = &module.entry_points[0];
            assert_eq!((entry.name.as_str(), module.entry_points.len()), (kernel.name, 1));
            assert_eq!(entry.stage, ShaderStage::Compute);
            for constants in choices(&module) {
                let (module, info) =
                    process_overrides(&module, &info, Some((ShaderStage::Compute, kernel.name)), &constants)
                        .unwrap_or_else(|error| panic!("{} {precision}: {error}", kernel.name));
                validate(kernel.name, &module, double);
                let words = spv::write_vec(&module, &info, &spv::Options::default(), None)
                    .unwrap_or_else(|error| panic!("{} {precision}: {error}", kernel.name));
                assert!(words.len() > 100);
                if !double {
                    let pipeline = msl::PipelineOptions::default();
                    let text = msl::write_string(&module, &info, &msl::Options::default(), &pipeline)
                        .unwrap_or_else(|error| panic!("{}: {error}", kernel.name))
                        .0;
                    assert!(text.contains(kernel.name));
                    let mut text = String::new();
                    let options = hlsl::Options { fake_missing_bindings: true, ..Default::default() };
                    hlsl::Writer::new(&mut text, &options, &Default::default())
                        .write(&module, &info, None)
                        .unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
                    assert!(text.contains(kernel.name));
                }
                translated += 1;
            }
        }
    }
    assert!(translated > 2 * KERNELS.len());
}

/// What drivers compute rightly in double precision; the rest is silently wrong.
const DOUBLE_PRECISION: [MathFunction; 7] = [
    MathFunction::Abs,
    MathFunction::Min,
    MathFunction::Max,
    MathFunction::Clamp,
    MathFunction::Sqrt,
    MathFunction::Dot,
    MathFunction::Cross,
];

#[test]
fn double_precision_keeps_to_what_drivers_compute() {
    let mut checked = 0;
    for kernel in KERNELS {
        let (module, info) = module(kernel, REAL_F64, true);
        let functions = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
        let entries = module
            .entry_points
            .iter()
            .enumerate()
            .map(|(index, entry)| (&entry.function, info.get_entry_point(index)));
        for (function, info) in functions.chain(entries) {
            for (handle, expression) in function.expressions.iter() {
                let double = info[handle].ty.inner_with(&module.types).scalar_width() == Some(8)
                    && info[handle].ty.inner_with(&module.types).scalar_kind()
                        == Some(naga::ScalarKind::Float);
                match expression {
                    Expression::Math { fun, .. } if double => {
                        assert!(DOUBLE_PRECISION.contains(fun), "{}: {fun:?} of an f64", kernel.name);
                        checked += 1;
                    }
                    Expression::Binary { op: naga::BinaryOperator::Modulo, .. } if double => {
                        panic!("{}: the remainder of an f64", kernel.name)
                    }
                    _ => {}
                }
            }
        }
    }
    assert!(checked > 100, "{checked}");
}

/// The text without comments.
fn code(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// The floating-point literals of a text, each with what stands right before it.
fn literals(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        let inside_name = at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || b"_.".contains(&bytes[at - 1]));
        if !bytes[at].is_ascii_digit() || inside_name {
            at += 1;
            continue;
        }
        let rest = &text[at..];
        let end = rest
            .char_indices()
            .find(|&(i, c)| {
                let sign_of_exponent = "+-".contains(c) && i > 0 && "eEp".contains(&rest[i - 1..i]);
                !(c.is_ascii_alphanumeric() || c == '.' || sign_of_exponent)
            })
            .map_or(rest.len(), |(i, _)| i);
        let literal = &rest[..end];
        let hexadecimal = literal.starts_with("0x");
        if literal.contains('.') || literal.contains(if hexadecimal { 'p' } else { 'e' }) {
            found.push((text[..at].trim_end().to_string(), literal.to_string()));
        }
        at += end;
    }
    found
}

/// A literal without a type may become an f32 in the middle of double precision; and a length has no natural size, so
/// no literal is a threshold for one.
#[test]
fn literals_have_a_type_and_are_no_tolerances() {
    let mut checked = 0;
    for kernel in KERNELS {
        for (before, literal) in literals(&code(kernel.text)) {
            let typed = before.ends_with("real(")
                || before.ends_with("real(-")
                || before.ends_with("real(1.0 /")
                || literal.ends_with('f');
            assert!(typed, "{}: {literal} after {}", kernel.name, &before[before.len().saturating_sub(40)..]);
            if !literal.ends_with('f') {
                let value: f64 = literal.parse().expect("a number");
                assert!(value == 0.0 || value >= 0.01, "{}: {value} looks like a tolerance", kernel.name);
            }
            checked += 1;
        }
    }
    assert!(checked > 100, "{checked}");
    for text in [REAL_F32, REAL_F64] {
        for (before, literal) in literals(&code(text)) {
            assert!(before.ends_with("real(") || literal.ends_with('f'), "{literal}");
        }
    }
}

#[test]
fn the_literals_of_a_text_are_found() {
    let found = literals("x1 = 0x1p-24f + real(0.5) * 2u; y.x0 = 1e-9;");
    let found: Vec<_> = found.iter().map(|(_, literal)| literal.as_str()).collect();
    assert_eq!(found, ["0x1p-24f", "0.5", "1e-9"]);
}
