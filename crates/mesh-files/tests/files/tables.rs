//! Tables of points: units of headings, the position among other triples, several lines in a file,
//! and the tables of 3D Slicer. The expected values of `tests/data/tables` come from its makers.

use crate::{Vertex, refused};
use mesh_files::{Centreline, Frame, Options, centreline_from_bytes, load_centreline};
use std::path::PathBuf;

fn table(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "data", "tables", name].iter().collect()
}

fn load(name: &str, line: Option<usize>) -> Result<Centreline, String> {
    load_centreline(table(name), &Options::default().with_line(line))
        .map_err(|error| error.to_string())
}

fn read(text: &str) -> Result<Centreline, String> {
    centreline_from_bytes("a.csv", text.as_bytes(), &Options::default())
        .map_err(|error| error.to_string())
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-4 * b.abs()
}

#[test]
fn the_units_of_headings_are_used_or_refused() {
    // The tip at z = 100 mm, and whether the file states the unit.
    for (name, states_unit) in [
        ("03_centimetres.csv", true),
        ("03_cm_taken_as_mm.csv", true),
        ("03_metres_and_mm.csv", true),
        ("03_metres_and_mm_brackets.csv", true),
        ("03_millimetres.csv", true),
        ("03_french_is_taken_as_mm.csv", true),
        ("03_units_cm.csv", true),
        ("03_units_cm_brackets.csv", true),
        ("03_units_in.csv", true),
        ("03_units_inch_brackets.csv", true),
        ("03_units_m_brackets.csv", true),
        ("03_units_m_m.csv", true),
        ("03_units_m_paren.csv", true),
        ("03_units_m_slash.csv", true),
        ("03_units_m_space.csv", true),
        ("03_units_meters.csv", true),
        ("03_units_micron.csv", true),
        ("03_units_pos_m.csv", true),
        ("03_units_ras_m.csv", true),
        ("03_units_um.csv", true),
        ("03_units_um_paren.csv", true),
        ("03_radius_diameter_Fr_paren.csv", false),
        ("03_radius_diameter_French.csv", true),
        ("03_radius_diameter_cm.csv", true),
        ("03_radius_od_mm.csv", false),
        ("03_radius_outer_diameter.csv", false),
        ("03_radius_rad_unit_row.csv", true),
        ("03_radius_radius_fr.csv", false),
        ("03_radius_radius_inch.csv", false),
        ("03_radius_radius_m_with_mm.csv", true),
        ("03_radius_radius_mm_with_m.csv", true),
        ("03_radius_radius_um_brackets.csv", true),
        ("03_radius_radius_um_with_mm.csv", true),
    ] {
        let line = load(name, None).unwrap_or_else(|error| panic!("{error}"));
        let tip = line.points[line.points.len() - 1];
        assert!(is_near(tip[2], 100.0) && tip[..2] == [0.0; 2], "{name}: {tip:?}");
        assert_eq!(line.states_unit, states_unit, "{name}");
        let has_radius = !name.starts_with("03_units") && !name.starts_with("03_c");
        assert_eq!(line.radii.is_some(), has_radius, "{name}");
        for radius in line.radii.into_iter().flatten() {
            assert!(is_near(radius, 1.0), "{name}: {radius}");
        }
    }
    for (name, expected) in [
        ("03_units_norm.csv", "line 1 of "),
        ("03_units_norm.csv", "has 'x_norm' in column 1, which is no position"),
        ("03_units_px.csv", "has 'x_px' in column 1, which is no position"),
        (
            "03_units_voxel.csv",
            "has 'x [voxel]' in column 1, whose unit 'voxel' is unknown; use mm",
        ),
    ] {
        refused(name, load(name, None), expected);
    }
    for (text, expected) in [
        ("x_mm,y_m,z_mm\n0,0,0\n0,0,1\n", "has different units in 'x_mm' and 'y_m'"),
        ("x_mm,y_mm,z\n0,0,0\n0,0,1\n", "has different units in 'x_mm' and 'z'"),
        ("x [m],y [m],z [m],radius\n0,0,0,1\n0,0,1,1\n", "has 'radius' in column 4 without a unit"),
        ("x,y,z,radius (furlong)\n0,0,0,1\n0,0,1,1\n", "whose unit 'furlong' is unknown"),
        ("x (world),y (world),z (world)\n0,0,0\n0,0,1\n", "whose unit 'world' is unknown"),
    ] {
        refused(text, read(text), expected);
    }
    // The unit of a column that is not needed says nothing, and millimetres hold for the radius.
    let text = "time (ms),x (mm),y (mm),z (mm),radius,force [N]\n0,1,2,3,4,5\n1,4,5,6,4,9\n";
    let line = read(text).unwrap();
    assert_eq!(
        (line.points[1], line.radii, line.states_unit),
        ([4.0, 5.0, 6.0], Some(vec![4.0]), true)
    );
    // A heading in a comment, as numpy writes it, if it has as many names as the rows have words.
    assert_eq!(read("# x [m] y [m] z [m]\n0 0 0\n0 0 0.5\n").unwrap().points[1][2], 500.0);
    assert_eq!(read("x (m) y (m) z (m)\n0 0 0\n0 0 0.5\n").unwrap().points[1][2], 500.0);
    assert_eq!(read("# x_m,y_m,z_m\n0,0,0\n0,0,0.5\n").unwrap().points[1][2], 500.0);
    assert_eq!(read("# x_m y_m z_m r_mm\n0 0 0 2\n0 0 0.5\n").unwrap().radii, Some(vec![2.0]));
    assert_eq!(read("# axes x, y, z of the scanner\n0,0,0\n0,0,0.5\n").unwrap().points[1][2], 0.5);
    // A remark below the heading.
    let remark = "# x [mm],y [mm],z [mm],diameter [cm]\n# catheter\n0,0,0,0.2\n0,0,5,0.2\n";
    assert_eq!(read(remark).unwrap().radii, Some(vec![1.0]));
    refused("fewer", read("# x_cm,y_cm,z_cm\n0,0,0,2\n0,0,5,2\n"), "");
    // Two units of one column.
    for units in ["mm,mm,mm", "cm,cm,mm"] {
        let text = format!("x_cm,y_cm,z_cm\n{units}\n0,0,0\n0,0,4\n");
        refused(units, read(&text), "has the unit 'mm' below 'cm'");
    }
    let twice = read("x_cm,y_cm,z_cm\ncm,[cm],(cm)\n0,0,0\n0,0,4\n");
    assert_eq!(twice.unwrap().points[1][2], 40.0);
}

#[test]
fn a_scale_applies_to_lengths_in_one_unit_only() {
    let scaled = |text: &str| {
        centreline_from_bytes("a.csv", text.as_bytes(), &Options::scaled(1e-3))
            .map(|line| (line.points[1][2], line.radii.map(|radii| radii[0])))
            .map_err(|error| error.to_string())
    };
    let rows = "\n0,0,0,2\n0,0,8,2\n";
    assert_eq!(scaled(&format!("x,y,z,radius{rows}")), Ok((8.0 * 1e-3, Some(2.0 * 1e-3))));
    assert_eq!(
        scaled(&format!("x_m,y_m,z_m,radius_mm{rows}")),
        Ok((8000.0 * 1e-3, Some(2.0 * 1e-3)))
    );
    refused("scale", scaled(&format!("x,y,z,radius_mm{rows}")), "so the scale 0.001 is ambiguous");
}

#[test]
fn the_position_is_read_among_other_triples_or_both_are_named() {
    let straight: [Vertex; 3] = [[0.0; 3], [0.0, 0.0, 10.0], [0.0, 0.0, 20.0]];
    for name in [
        "04_frame_rz.csv",
        "04_position_first.csv",
        "04_rotation_taken_as_position.csv",
        "04_rx_first.csv",
        "04_tangent_first.csv",
        "04_two_dir_first.csv",
        "04_two_index_pos.csv",
        "04_two_kappa_first.csv",
        "04_two_normal_points.csv",
        "04_two_nx_first.csv",
        "04_two_omega_first.csv",
        "04_two_pos_last_xyz_prefix.csv",
        "04_two_quat.csv",
        "04_two_qw_first.csv",
        "04_two_rot_first.csv",
        "04_two_rx_then_ras.csv",
        "04_two_rx_then_xyz.csv",
        "04_two_s_pos.csv",
        "04_two_time_ms_xyz.csv",
        "04_two_time_pos.csv",
        "04_two_time_xyz.csv",
        "04_two_u_then_xyz.csv",
        "04_two_ux_first.csv",
        "04_two_vel_pos.csv",
        "04_two_vx_first.csv",
    ] {
        let line = load(name, None).unwrap_or_else(|error| panic!("{error}"));
        let expected = match name {
            "04_rotation_taken_as_position.csv" => &straight[..2],
            _ => &straight[..],
        };
        if name == "04_tangent_first.csv" {
            assert_eq!(line.points, [[0.0; 3], [0.0, 0.0, 10.0], [0.0, 1.0, 20.0]]);
        } else {
            assert_eq!(line.points, expected, "{name}");
        }
        let frame = (name == "04_two_rx_then_ras.csv").then_some(Frame::Ras);
        assert_eq!((line.frame, line.radii), (frame, None), "{name}");
    }
    for (name, expected) in [
        ("04_two_base_tip.csv", "has 'base_x' and 'tip_x', and both may be the position"),
        ("04_two_force_pos.csv", "has 'Fx' in column 1, which is no position"),
        ("04_two_xyz_twice.csv", "has 'x' in column 4"),
    ] {
        refused(name, load(name, None), expected);
    }
    for (names, expected) in [
        ("r,a,s,t,u,v", Ok(Some(Frame::Ras))),
        ("x,y,z,r,a,s", Err("has 'x' and 'r', and both may be the position")),
        ("x,y,z,Points:0,Points:1,Points:2", Err("has 'x' and 'Points:0', and both")),
        ("r,a,s,r,a,s", Err("has several columns 'r'")),
        ("qx,qy,qz,vx,vy,vz", Err("has 'qx' in column 1, which is no position")),
        ("x1,y1,z1,x2,y2,z2", Err("has 'x1' and 'x2', and both may be the position")),
        ("x_ras,y_ras,z_ras,vx,vy,vz", Ok(Some(Frame::Ras))),
        ("X coordinate,Y coordinate,Z coordinate,nx,ny,nz", Ok(None)),
    ] {
        let answer = read(&format!("{names}\n1,2,3,4,5,6\n2,3,4,5,6,7\n"));
        match expected {
            Ok(frame) => {
                let line = answer.unwrap();
                assert_eq!((line.points[0], line.frame), ([1.0, 2.0, 3.0], frame), "{names}");
            }
            Err(expected) => refused(names, answer, expected),
        }
    }
}

#[test]
fn branches_are_lines_of_their_own() {
    let trunk: [Vertex; 3] = [[0.0; 3], [0.0, 0.0, 10.0], [0.0, 0.0, 20.0]];
    let ends = [[-8.0, 0.0, 30.0], [8.0, 0.0, 30.0]];
    for name in [
        "05_branches_blank_line.dat",
        "05_branches_csv_noheading.csv",
        "05_branches_groupids.csv",
        "05_branches_paraview.csv",
        "05_line_id_last.csv",
        "05_segment_id_first.csv",
        "05_shape_column_as_centreline.csv",
        "05_two_headings.csv",
        "05_vmtk_two_branches.dat",
        "05_vmtk_two_branches.vtp",
    ] {
        refused(name, load(name, None), "holds 2 lines; choose one from 0 to 1");
        for (number, end) in ends.into_iter().enumerate() {
            let line = load(name, Some(number)).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(line.points, [&trunk[..], &[end]].concat(), "{name}");
            // The radius of the vessel is none of the robot's.
            assert_eq!(line.radii.is_some(), name == "05_line_id_last.csv", "{name}");
        }
        refused(name, load(name, Some(2)), "has no line 2, but 2");
    }
    let branch = load("05_branch_a.csv", None).unwrap();
    assert_eq!(branch.points, [&trunk[..], &ends[..1]].concat());
    assert_eq!(load("05_branch_a.csv", Some(0)), Ok(branch));
    let count = |text: &str| match read(text) {
        Ok(line) => Ok(line.points.len()),
        Err(error) => Err(error.split("holds ").nth(1).unwrap_or(&error).chars().take(7).collect()),
    };
    let two = Err("2 lines".to_owned());
    for (text, expected) in [
        // Names of lines, in turn; a column that counts rows; one that names all rows alike.
        ("x,y,z,vessel\n0,0,0,left\n9,0,0,right\n0,0,1,left\n9,0,1,right\n", two.clone()),
        ("segment,x,y,z\n0,0,0,0\n1,0,0,1\n2,0,0,2\n", Ok(3)),
        ("x,y,z,branch\n0,0,0,7\n0,0,1,7\n", Ok(2)),
        // Empty lines at both ends, after each point, and between two parts.
        ("\n\n0,0,0\n0,0,1\n\n\n", Ok(2)),
        ("0,0,0\n\n0,0,1\n\n0,0,2\n", Ok(3)),
        ("0,0,0\r\r\n0,0,1\r\r\n", Ok(2)),
        ("0,0,0\n0,0,1\n\n\n0,0,5\n0,0,6\n", two.clone()),
        ("x,y,z\n\n0,0,0\n0,0,1\n# the end\n0,0,2\n", Ok(3)),
        // A closed line, a point that is held, and one step back.
        ("0,0,0\n1,0,0\n1,1,0\n0,1,0\n0,0,0\n", Ok(5)),
        ("0,0,0\n0,0,0\n0,0,1\n0,0,1\n0,0,2\n", Ok(5)),
        ("0,0,0\n0,0,1\n0,0,2\n0,0,1\n", Ok(4)),
        // A second branch from the root, and from the middle.
        ("0,0,0\n0,0,1\n0,0,2\n0,0,3\n0,0,0\n0,1,0\n", two.clone()),
        ("0,0,0\n0,0,1\n0,0,2\n0,0,3\n0,0,4\n0,0,1\n0,1,1\n", two),
    ] {
        assert_eq!(count(text), expected, "{text}");
    }
}

#[test]
fn robots_and_times_are_told_apart_and_times_of_points_are_not() {
    let rows = |name: &str, value: &dyn Fn(usize) -> String| {
        let rows = (0..6).map(|row| format!("{},{},0,{}\n", value(row), row / 3, row % 3));
        format!("{name},x,y,z\n{}", rows.collect::<String>())
    };
    for name in ["id", "robot", "Robot ID", "time", "time (s)", "step", "t"] {
        // Two robots of three points, one after the other and in turn.
        let two = rows(name, &|row| format!("0.{}", row / 3));
        refused(name, read(&two), "holds 2 lines; choose one from 0 to 1");
        let turns = rows(name, &|row| format!("0.{}", row % 2));
        refused(name, read(&turns), "holds 2 lines; choose one from 0 to 1");
        // A number for each point, a clock that ticks seldom, and one value for all.
        for per_line in [1, 6] {
            let each = rows(name, &|row| (row / per_line).to_string());
            assert_eq!(read(&each).unwrap().points.len(), 6, "{name}");
        }
        let coarse = rows(name, &|row| [0, 1, 1, 2, 3, 4][row].to_string());
        assert_eq!(read(&coarse).unwrap().points.len(), 6, "{name}");
    }
}

#[test]
fn two_columns_of_radii_are_refused() {
    for (heading, first, second) in [
        ("x,y,z,radius,radius", "radius", "radius"),
        ("x,y,z,radius,diameter", "radius", "diameter"),
        ("x,y,z,diameter (mm),r", "r", "diameter (mm)"),
        ("OD,x,y,z,outer diameter", "OD", "outer diameter"),
        // Inner and outer, no inches.
        ("x,y,z,radius_in,radius_out", "radius_in", "radius_out"),
        ("r_in,x,y,z,r_out", "r_in", "r_out"),
    ] {
        let text = format!("{heading}\n0,0,0,1,2\n0,0,1,1,2\n");
        let expected = format!("has '{first}' and '{second}', and both may be the radius");
        refused(heading, read(&text), &expected);
    }
    // r is the first coordinate, and the radius of a vessel is none of the robot's.
    let line = read("r,a,s,radius,MaximumInscribedSphereRadius\n0,0,0,1,9\n0,0,1,1,9\n").unwrap();
    assert_eq!(line.radii, Some(vec![1.0]));
}

#[test]
fn a_position_whose_name_does_not_say_so_is_doubted() {
    let doubts = |heading: &str| read(&format!("{heading}\n0,0,0\n0,0,1\n0,0,2\n")).unwrap().doubts;
    for heading in ["foo_x,foo_y,foo_z", "magX,magY,magZ", "x_field,y_field,z_field"] {
        let [x, y, z]: [&str; 3] = heading.split(',').collect::<Vec<_>>().try_into().unwrap();
        let expected = format!("'{x}', '{y}' and '{z}' are read as the position, but their names");
        let [found] = &doubts(heading)[..] else { panic!("{heading}") };
        assert!(found.starts_with(&expected), "{found}");
    }
    for heading in [
        "x,y,z",
        "X [mm],Y [mm],Z [mm]",
        "r,a,s",
        "pos_x,pos_y,pos_z",
        "X position,Y position,Z position",
        "X-Koordinate,Y-Koordinate,Z-Koordinate",
        "Tx,Ty,Tz",
        "Points:0,Points:1,Points:2",
        "tip_x_mm,tip_y_mm,tip_z_mm",
        "x_ras,y_ras,z_ras",
    ] {
        assert_eq!(doubts(heading), [""; 0], "{heading}");
    }
}

#[test]
fn numbers_of_lines_are_not_read_as_coordinates_in_silence() {
    let rows = |row: &dyn Fn(usize) -> String| (0..5).map(row).collect::<String>();
    for first in [0, 1] {
        let counted = rows(&|k| format!("{},3.5,{},{}\n", k + first, 8 - k, 20 + k));
        let [doubt] = &read(&counted).unwrap().doubts[..] else { panic!("{first}") };
        assert!(doubt.starts_with("the first column counts the lines, but"), "{doubt}");
    }
    // A straight robot of constant radius, three columns, other steps, and a heading.
    for plain in [
        rows(&|k| format!("{k},3,8,2\n")),
        rows(&|k| format!("{k},3,{}\n", 20 + k)),
        rows(&|k| format!("{},3,0,{}\n", 2 * k, 20 + k)),
        format!("x,y,z,radius\n{}", rows(&|k| format!("{k},3,0,{}\n", 20 + k))),
    ] {
        assert_eq!(read(&plain).unwrap().doubts, [""; 0], "{plain}");
    }
}

#[test]
fn a_shape_whose_number_comes_again_is_doubted() {
    let file = std::env::temp_dir().join(format!("shapes-again-{}.csv", std::process::id()));
    std::fs::write(&file, "0,0,0,0\n0,0,0,1\n1,0,0,0\n1,0,0,1\n0,0,0,2\n0,0,0,3\n").unwrap();
    let shapes = mesh_files::load_shapes(&file, &Options::default()).unwrap();
    std::fs::remove_file(&file).unwrap();
    let doubts: Vec<_> = shapes.iter().map(|(_, shape)| shape.doubts.len()).collect();
    assert_eq!(doubts, [0, 0, 1]);
    assert!(shapes[2].1.doubts[0].starts_with("line 5 begins a shape whose number stands before"));
}

#[test]
fn steps_back_are_found_in_any_frame_and_unit() {
    let mut draws = crate::mutations::Draws(11);
    let mut draw = || draws.below(1 << 20) as f64 / f64::from(1 << 20);
    let mut split = 0;
    for round in 0..300 {
        let scale = 2_f64.powi([-30, 0, 30][round % 3]);
        // A walk of steps of 1; and a second walk from one of its points, or none.
        let walk = |from: Vertex, way: Vertex, count: usize, draw: &mut dyn FnMut() -> f64| {
            let mut points = vec![from];
            for _ in 0..count {
                let last = points[points.len() - 1];
                let noise = [draw(), draw(), draw()].map(|x| 0.4 * x - 0.2);
                points.push([0, 1, 2].map(|axis| last[axis] + way[axis] + noise[axis]));
            }
            points
        };
        let first = walk([0.0; 3], [0.0, 0.0, 1.0], 8 + round % 9, &mut draw);
        let joint = (draw() * (first.len() - 6) as f64) as usize;
        let second = walk(first[joint], [0.0, 1.0, 0.0], 5, &mut draw);
        let is_tree = round % 2 == 0;
        let all = if is_tree { [&first[..], &second].concat() } else { first.clone() };
        let rows = all.iter().map(|p| p.map(|x| format!("{:e}", scale * x)).join(","));
        let answer = read(&rows.collect::<Vec<_>>().join("\n"));
        assert_eq!(answer.is_err(), is_tree, "{round}");
        split += usize::from(is_tree);
    }
    assert!(split == 150);
}

#[test]
fn tables_of_slicer_have_their_frame_and_only_points_that_are_defined() {
    let bent: [Vertex; 3] = [[0.0; 3], [0.0, 1.5, 10.0], [0.0, 4.0, 20.0]];
    let (lps, ras) = (Some(Frame::Lps), Some(Frame::Ras));
    for (name, frame, skipped) in [
        ("06_slicer_table.csv", lps, 0),
        ("06_slicer_table.tsv", lps, 0),
        ("06_slicer_table_described.csv", lps, 0),
        ("06_slicer_table_minimal.csv", ras, 0),
        ("06_slicer_table_undefined.csv", lps, 1),
        ("06_numeric_label_undefined.csv", lps, 1),
        ("06_defined_numeric_only.csv", lps, 1),
        ("06_undefined_point_taken.csv", lps, 1),
        ("06_empty_text_last.csv", None, 0),
        ("06_name_first.csv", None, 0),
        ("06_text_last.csv", None, 0),
        ("06_timestamp.csv", None, 0),
        ("06_fcsv_as_csv.csv", lps, 0),
    ] {
        let line = load(name, None).unwrap_or_else(|error| panic!("{error}"));
        let expected: Vec<Vertex> = match name {
            "06_undefined_point_taken.csv" => vec![bent[0], bent[2]],
            "06_fcsv_as_csv.csv" => bent[..line.points.len()].to_vec(),
            // In the other frame.
            "06_slicer_table_minimal.csv" => bent.map(|[x, y, z]| [x, 0.0 - y, z]).to_vec(),
            _ => bent.to_vec(),
        };
        assert_eq!(line.points, expected, "{name}");
        assert_eq!((line.frame, line.skipped_points), (frame, skipped), "{name}");
    }
    let tabs = "label\tr\ta\ts\tdefined\tdescription\nF-1\t0\t0\t0\t1\tone, and; more\nF-2\t\t\t\t0\t\n\
        F-3\t0\t0\t2\t1\t\"a\"\n";
    let line = centreline_from_bytes("a.tsv", tabs.as_bytes(), &Options::default()).unwrap();
    assert_eq!((line.points.len(), line.skipped_points, line.frame), (2, 1, ras));
    let bad = "label,r,a,s,defined\nF-1,0,0,0,1\nF-2,0,0,1,yes\n";
    refused("defined", read(bad), "line 3 of a.csv has 'yes' in the column 'defined', not 0 or 1");
    let none = "label,r,a,s,defined\nF-1,0,0,0,0\nF-2,0,0,1,0\n";
    refused("none", read(none), "holds a line of 0 points");
    // What is needed must be a number, and nothing else.
    for (text, expected) in [
        ("label,x,y,z\na,0,0,0\nb,0,,1\n", "line 3 of a.csv has nothing in column 3"),
        ("x,y,z,label,radius\n0,0,0,a,1\n0,0,1,b,wide\n", "line 3 of a.csv has 'wide' in column 5"),
        ("a,0,0,0\nb,0,0,1\n", "line 1 of a.csv has 'a' in column 1"),
    ] {
        refused(text, read(text), expected);
    }
}

#[test]
fn lines_of_very_many_columns_take_no_memory() {
    for text in
        [",".repeat(3_000_000), "a,".repeat(1_000_000), "x,y,z".to_owned() + &",".repeat(3_000_000)]
    {
        for text in [text.clone(), format!("x,y,z\n{text}"), format!("# {text}\n0,0,0\n0,0,1\n")] {
            let mut answer = Ok(());
            let taken = allocation_counter::measure(|| answer = read(&text).map(drop));
            refused("columns", answer, "has more than 4096 columns");
            assert!(taken.bytes_max < 1 << 20, "{}", taken.bytes_max);
        }
    }
}
