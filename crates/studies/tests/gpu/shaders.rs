//! Every shader, on machines without a GPU: it is valid in both precisions and translates to what
//! drivers take, and it keeps the rules that no driver checks.

use continuum_studies::gpu::{Discs, Form, Pair, forms, pairs};
use gpu_batch::{Precision, Shader};
use naga::back::{PipelineConstants, hlsl, msl, pipeline_constants::process_overrides, spv};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Expression, MathFunction, Module, ShaderStage};
use parry_continuum::gpu::laboratory;
use real_polynomial_roots::gpu::{self as roots, Finder};
use std::path::Path;

const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

/// Every kernel in a precision.
fn kernels(precision: Precision) -> Vec<Shader> {
    let mut kernels = laboratory::kernels(precision);
    if precision == Precision::F32 {
        kernels.extend(laboratory::search_kernels());
    }
    for discs in [Discs::Convex, Discs::ClosedForm, Discs::Companion] {
        kernels.push(laboratory::every_pair(precision, &discs.route(precision)));
        kernels.extend(Pair::ALL.map(|pair| pairs::shader(pair, discs, precision)));
    }
    kernels.extend(Form::ALL.map(|form| forms::shader(form, precision)));
    for finder in Finder::ALL {
        kernels.extend([1, 4, 15].map(|degree| roots::shader(finder, precision, degree)));
    }
    kernels
}

fn capabilities(precision: Precision) -> Capabilities {
    if precision == Precision::F64 { Capabilities::FLOAT64 } else { Capabilities::empty() }
}

fn parse(kernel: &Shader, precision: Precision) -> (Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(&kernel.text).unwrap_or_else(|error| {
        panic!("{}: {}", kernel.entry_point, error.emit_to_string(&kernel.text))
    });
    let info = validate(kernel.entry_point, &module, precision);
    (module, info)
}

fn validate(name: &str, module: &Module, precision: Precision) -> ModuleInfo {
    Validator::new(ValidationFlags::all(), capabilities(precision))
        .validate(module)
        .unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

/// Every value that the kernel's overrides are given.
fn choices(module: &Module) -> Vec<PipelineConstants> {
    let mut choices = vec![PipelineConstants::default()];
    for (_, constant) in module.overrides.iter() {
        assert_eq!(constant.name.as_deref(), Some("CULLING"));
        choices.push([("CULLING".into(), 0.0)].into_iter().collect());
    }
    choices
}

#[test]
fn every_kernel_translates() {
    for precision in PRECISIONS {
        for kernel in kernels(precision) {
            let name = kernel.entry_point;
            let (module, info) = parse(&kernel, precision);
            let entry = &module.entry_points[0];
            assert_eq!((entry.name.as_str(), module.entry_points.len()), (name, 1));
            assert_eq!(entry.stage, ShaderStage::Compute);
            for constants in choices(&module) {
                let (module, info) = process_overrides(
                    &module,
                    &info,
                    Some((ShaderStage::Compute, name)),
                    &constants,
                )
                .unwrap_or_else(|error| panic!("{name} {precision:?}: {error}"));
                validate(name, &module, precision);
                let words = spv::write_vec(&module, &info, &spv::Options::default(), None)
                    .unwrap_or_else(|error| panic!("{name} {precision:?}: {error}"));
                assert!(words.len() > 100);
                if precision == Precision::F32 {
                    let pipeline = msl::PipelineOptions::default();
                    let text =
                        msl::write_string(&module, &info, &msl::Options::default(), &pipeline)
                            .unwrap_or_else(|error| panic!("{name}: {error}"))
                            .0;
                    assert!(text.contains(name));
                    let mut text = String::new();
                    let options =
                        hlsl::Options { fake_missing_bindings: true, ..Default::default() };
                    hlsl::Writer::new(&mut text, &options, &Default::default())
                        .write(&module, &info, None)
                        .unwrap_or_else(|error| panic!("{name}: {error}"));
                    assert!(text.contains(name));
                }
            }
        }
    }
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
    for kernel in kernels(Precision::F64) {
        let (module, info) = parse(&kernel, Precision::F64);
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
                        assert!(
                            DOUBLE_PRECISION.contains(fun),
                            "{}: {fun:?} of an f64",
                            kernel.entry_point
                        );
                        checked += 1;
                    }
                    Expression::Binary { op: naga::BinaryOperator::Modulo, .. } if double => {
                        panic!("{}: the remainder of an f64", kernel.entry_point)
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
    text.lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// The floating-point literals of a text, each with what stands right before it.
fn literals(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        let inside_name =
            at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || b"_.".contains(&bytes[at - 1]));
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

/// A literal without a type may become an f32 in the middle of double precision; and a length has
/// no natural size, so no literal is a threshold for one.
#[test]
fn literals_have_a_type_and_are_no_tolerances() {
    let mut checked = 0;
    for kernel in kernels(Precision::F64) {
        for line in code(&kernel.text).lines() {
            // What precedes the functions is generated, and the start values of iterations are
            // powers of two.
            let is_constant = line.starts_with("const ");
            for (before, literal) in literals(line) {
                let typed = before.ends_with("real(")
                    || before.ends_with("real(-")
                    || before.ends_with("real(1.0 /")
                    || literal.ends_with('f');
                assert!(typed, "{}: {literal} in {line}", kernel.entry_point);
                if !literal.ends_with('f') && !is_constant {
                    let value: f64 = literal.parse().expect("a number");
                    assert!(
                        value == 0.0 || value >= 0.01,
                        "{}: {value} looks like a tolerance",
                        kernel.entry_point
                    );
                }
                checked += 1;
            }
        }
    }
    assert!(checked > 100, "{checked}");
}

/// Each text names its twin on the CPU by the twin's file.
#[test]
fn every_twin_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut twins = 0;
    for (shaders, sources) in [
        ("src/gpu/shaders/kernels", "src"),
        ("src/gpu/shaders/search", "src"),
        ("src/gpu/shaders/shared", "src"),
        ("crates/roots/src/gpu/shaders", "crates/roots/src"),
        ("crates/studies/src/gpu/shaders", "crates/studies/src"),
    ] {
        for file in std::fs::read_dir(root.join(shaders)).expect("a folder of shaders") {
            let path = file.expect("a shader").path();
            let text = std::fs::read_to_string(&path).expect("a shader");
            for word in text.split_whitespace() {
                let word = word.trim_matches(|c: char| !c.is_ascii_alphanumeric());
                if word.ends_with(".rs") {
                    let twin = root.join(sources).join(word);
                    assert!(twin.is_file(), "{}: there is no {word}", path.display());
                    twins += 1;
                }
            }
        }
    }
    assert!(twins > 20, "{twins}");
}

#[test]
fn the_literals_of_a_text_are_found() {
    let found = literals("x1 = 0x1p-24f + real(0.5) * 2u; y.x0 = 1e-9;");
    let found: Vec<_> = found.iter().map(|(_, literal)| literal.as_str()).collect();
    assert_eq!(found, ["0x1p-24f", "0.5", "1e-9"]);
}
