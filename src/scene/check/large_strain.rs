//! Checks that solids of large strain can be modelled.

mod idle;
mod part;
mod strand;

use super::layers::Materials;
use super::{Checker, fits, layers, material};
use crate::laws::Material;
use crate::scene::large_strain::{
    KernelIntegration, KernelSettings, LargeStrain, LargeStrainStart, LargeStrainSymmetry,
    Mechanics, MotionSteps, SolidShape,
};
use crate::scene::locate::Path;
use crate::scene::types::FaceName;
use crate::scene::{LoadComponent, Part, Quadrilateral};

/// Most nodes of a body.
const MOST_NODES: f64 = 2e6;

pub fn check(checker: &mut Checker) {
    for (name, solid) in checker.scene.large_strains() {
        let path = Path::default().key("body").key(name);
        check_shape(checker, &path, solid);
        let thickness = Some(solid.extents()[2]).filter(|thickness| *thickness > 0.0);
        let (material, layers) = (solid.material.as_ref(), solid.layers.as_deref());
        let own = Materials { material, layers, check: material::sound };
        layers::materials(checker, &path, own, thickness);
        check_material(checker, &path, solid);
        idle::check(checker, name, solid);
        check_order(checker, &path.at("mesh.order"), solid);
        check_kernels(checker, &path, solid);
        check_section(checker, &path, solid);
        check_heat(checker, &path, solid);
        check_faces(checker, &path, solid);
        match solid.steps() {
            Some(MotionSteps::Explicit) => check_explicit(checker, &path, solid),
            Some(MotionSteps::Implicit) => check_implicit(checker, &path, name, solid),
            None => check_rest(checker, &path, name, solid),
        }
        if solid.inertia {
            check_velocity(checker, &path, solid);
        }
        let message = "a body that touches nothing below rubs on nothing";
        let fine = solid.friction.is_none() || solid.is_above();
        checker.require(fine, &path.key("friction"), message, "none; with explicit motion");
    }
    for (name, solid) in checker.scene.solids() {
        let choices = solid.layers.iter().flatten().map(|layer| &layer.material);
        for choice in solid.material.iter().chain(choices) {
            if choice.material().law.deformation().is_of_large_strain() {
                let path = Path::default().key("body").key(name);
                let message = "this law is one of large strain";
                checker.refuse(
                    &path,
                    message,
                    "`strain = \"finite\"`, or `model = \"thermoelastic\"`",
                );
            }
        }
    }
}

fn check_shape(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    let is_flat = solid.dimension == 2;
    let [x, y, z] = solid.extents();
    if let SolidShape::Quadrilateral(own) = &solid.shape
        && !quadrilateral(checker, path, own, is_flat)
    {
        return;
    }
    if let Some(own) = solid.part()
        && !part::check(checker, path, solid, own)
    {
        return;
    }
    if let Some(own) = solid.strand()
        && !strand::check(checker, path, solid, own)
    {
        return;
    }
    let smallest = solid.smallest();
    let spacing = solid.spacing();
    let path_of_spacing = path.at("mesh.spacing");
    if solid.mesh.spacing.is_some_and(|spacing| spacing <= 0.0) {
        checker.refuse(&path_of_spacing, "the distance of nodes must be positive", "> 0 (m)");
        return;
    }
    if smallest <= 0.0 {
        // Refused as numbers.
        return;
    }
    let is_thick = solid.part().is_some() || fits(spacing, smallest);
    checker.require(
        is_thick,
        &path_of_spacing,
        "the body is thinner than an element",
        format!("up to {smallest} m, a tenth of it or less for results"),
    );
    let across = if solid.is_axisymmetric() { [0.5 * x, spacing, z] } else { [x, y, z] };
    let count = |a: usize| if is_flat && a == 1 { 1.0 } else { (across[a] / spacing).max(1.0) };
    let nodes = match solid.strand() {
        Some(own) => own.sweep(solid.form()).volume() / spacing.powi(solid.dimension as i32),
        None => count(0) * count(1) * count(2),
    };
    let dimensions = if is_flat || solid.is_axisymmetric() { 2.0 } else { 3.0 };
    // Of the smallest spacings the number of nodes is beyond all numbers.
    let size = |a: usize| (across[a] / spacing).max(1.0).log2();
    let logarithm = match solid.strand() {
        Some(own) => {
            let axes = solid.dimension as f64;
            own.sweep(solid.form()).volume().log2() - axes * spacing.log2()
        }
        None => size(0) + if is_flat { 0.0 } else { size(1) } + size(2),
    };
    let coarser = (spacing.log2() + (logarithm - MOST_NODES.log2()) / dimensions).exp2();
    checker.require(
        nodes <= MOST_NODES,
        &path_of_spacing,
        format!("the mesh would have {nodes:.1e} nodes"),
        format!("a `mesh.spacing` of {coarser:.1e} m or more: at most {MOST_NODES:e} nodes"),
    );
    if is_flat && matches!(solid.shape, SolidShape::Disc(_)) {
        let message = "a disc has no plane model";
        checker.refuse(&path.key("dimension"), message, "3; or a box, or a ball");
    }
    let is_round = matches!(solid.shape, SolidShape::Ball(_) | SolidShape::Disc(_));
    let may_be_round = is_round || solid.part().is_some();
    if solid.symmetry == LargeStrainSymmetry::Axisymmetric && (!may_be_round || is_flat) {
        let message = "only a disc, a ball and a part in three dimensions are round about z";
        checker.refuse(&path.key("symmetry"), message, "auto, none, quarter");
    }
    if solid.symmetry == LargeStrainSymmetry::Quarter && solid.is_quadrilateral() {
        let message = "a quadrilateral does not mirror itself in x = 0";
        checker.refuse(&path.key("symmetry"), message, "auto, none");
    }
    if solid.symmetry == LargeStrainSymmetry::Quarter && solid.strand().is_some() {
        let message = "a strand is modelled along the whole of its path";
        let allowed = "auto, none; half of the path, with a roller";
        checker.refuse(&path.key("symmetry"), message, allowed);
    }
    if solid.symmetry == LargeStrainSymmetry::Quarter && solid.part().is_some() {
        let message = "a part is modelled as the file has it";
        let allowed = "auto, none, axisymmetric; a quarter in the file, with rollers";
        checker.refuse(&path.key("symmetry"), message, allowed);
    }
}

/// Refuses corners that go round the wrong way or inwards, and a missing depth; returns true if there is none of these.
fn quadrilateral(checker: &mut Checker, path: &Path, own: &Quadrilateral, is_flat: bool) -> bool {
    let path = path.at("shape.quadrilateral");
    if !checker.is_fine(&path.key("corners")) {
        return false;
    }
    let message = "the corners are not those of a quadrilateral with angles below 180°, in order";
    let allowed = "[x, z] of bottom left, bottom right, top right, top left";
    let corners = checker.require(
        own.is_convex() && own.begins_below(),
        &path.key("corners"),
        message,
        allowed,
    );
    let message = "a body in three dimensions has a depth";
    let depth = checker.require(
        is_flat || own.depth.is_some(),
        &path.key("depth"),
        message,
        "a positive number (m), or `dimension = 2`",
    );
    let message = "a plane body has no depth: its totals are those of a metre";
    let fine = !is_flat || own.depth.is_none();
    checker.require(fine, &path.key("depth"), message, "no `depth`, or `dimension = 3`");
    corners && depth
}

/// Refuses sections of bodies that are not plane, and sheets of which something needs the stress across them.
fn check_section(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    let at = path.key("section");
    let message = "a body in three dimensions is no section";
    let fine = solid.section.is_none() || solid.dimension == 2;
    checker.require(fine, &at, message, "`dimension = 2`, or no `section`");
    if !solid.is_sheet() {
        return;
    }
    let message = "the law of concrete does not find the strain across a sheet where it softens";
    checker.require(!solid.is_of_concrete(), &at, message, "plane_strain, or another law");
    let message = "the heat that a sheet conducts depends on its thickness, which is not modelled";
    let allowed = "plane_strain, or no thermal conditions";
    checker.require(!solid.conducts(), &at, message, allowed);
    for (&name, _) in solid.faces.iter().filter(|(_, face)| face.pressure.is_some()) {
        let path = path.key("faces").key(name.as_str()).key("pressure");
        let message = "the pressure on an edge of a sheet acts on its present thickness";
        checker.refuse(&path, message, "`traction`, or `section = \"plane_strain\"`");
    }
}

fn check_kernels(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    let fine = solid.sph.is_none() || solid.mechanics == Mechanics::Sph;
    let message = "these are settings of smoothed particles";
    checker.require(fine, &path.key("sph"), message, "`mechanics = \"sph\"`, or no `sph`");
    let Some(settings) = solid.rkpm else { return };
    let path = path.key("rkpm");
    let fine = matches!(solid.mechanics, Mechanics::Rkpm | Mechanics::Efg);
    let message = "these are settings of reproducing kernels";
    checker.require(fine, &path, message, "`mechanics = \"rkpm\"` or `\"efg\"`, or no `rkpm`");
    let fine = settings.support.is_none_or(|support| support > settings.basis as f64);
    let message = "supports reach too few nodes for this basis";
    checker.require(fine, &path.key("support"), message, "above `basis`, up to 6");
    if settings.smoothing.is_some() {
        check_smoothing(checker, &path.key("smoothing"), solid, settings);
    }
}

/// Checks that quadratic functions have what they need.
fn check_order(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    if solid.order() == 1 {
        return;
    }
    let message = "only finite elements have functions of this order";
    checker.require(
        solid.mechanics == Mechanics::Fem,
        path,
        message,
        "1, or `mechanics = \"fem\"`",
    );
    let message = "the cells of a part are linear";
    checker.require(solid.part().is_none(), path, message, "1, or another shape");
    let message = "quadratic elements have a uniform temperature";
    checker.require(!solid.conducts(), path, message, "1, or no heat flow");
}

fn check_smoothing(
    checker: &mut Checker,
    path: &Path,
    solid: &LargeStrain,
    settings: KernelSettings,
) {
    let fine = settings.integration == KernelIntegration::Nsni;
    let message =
        "a second smoothing leaves other integration without stiffness against short waves";
    checker.require(fine, path, message, "`integration = \"nsni\"`, or no `smoothing`");
    let fine = matches!(solid.symmetry, LargeStrainSymmetry::Auto | LargeStrainSymmetry::None);
    let message = "a second smoothing goes on across planes of symmetry and the axis";
    checker.require(fine, path, message, "`symmetry = \"none\"`, or no `smoothing`");
    let least = LEAST_SMOOTHING * solid.spacing();
    let fine =
        settings.smoothing.is_none_or(|radius| radius >= least && radius <= MOST_SMOOTHING * least);
    let message = "the radius is that of too few or too many nodes";
    let allowed = format!("{least} to {} m, or another `mesh.spacing`", MOST_SMOOTHING * least);
    checker.require(fine, path, message, allowed);
}

/// Smallest radius of smoothing over the distance of nodes, and the largest over the smallest.
const LEAST_SMOOTHING: f64 = 2.0;
const MOST_SMOOTHING: f64 = 10.0;

fn check_material(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    let own = solid.material.iter().map(|choice| (path.key("material"), choice.material()));
    for (path, material) in own.collect::<Vec<_>>() {
        check_law(checker, &path, material, solid.initial_temperature);
    }
    for (n, layer) in solid.layers.iter().flatten().enumerate() {
        let path = path.key("layers").index(n);
        check_law(
            checker,
            &path.key("material"),
            layer.material.material(),
            solid.initial_temperature,
        );
        let message = "layers of a solid of large strain touch without resistance";
        let fine = layer.contact_resistance.is_none();
        checker.require(fine, &path.key("contact_resistance"), message, "no `contact_resistance`");
    }
    if solid.layers.is_none() {
        return;
    }
    let message =
        "layers are those of finite elements in equilibrium, and of a shape with a flat top";
    let fine = solid.mechanics == Mechanics::Fem && !solid.inertia && solid.plate().is_some();
    let allowed = "`mechanics = \"fem\"`, `inertia = false`, a box or a disc; or `material`";
    checker.require(fine, &path.key("layers"), message, allowed);
}

fn check_law(checker: &mut Checker, path: &Path, material: &Material, temperature: f64) {
    if material.fracture.weibull.is_some() {
        let message = "the probability of failure is that of small strain";
        checker.refuse(&path.key("weibull"), message, "no `weibull`");
    }
    if material.fracture.cracking.is_some() {
        let message = "cracks run in bodies of small strain";
        checker.refuse(&path.key("fracture"), message, "no `fracture`");
    }
    let constants = path.key("kcc");
    if let Some((message, allowed)) = material.law.deformation().obstacle(temperature) {
        // A number beyond its own bounds is reason enough.
        if checker.is_fine(&constants) {
            checker.refuse(&constants, message, allowed);
        }
    } else if material.law.deformation().large_strain(temperature).is_none() {
        let message = "a solid of large strain cannot be made of this material";
        let allowed = "`model = \"neo_hookean\"` with `young` and `poisson`, also of a `substance`; `\"concrete\"` with `kcc`, too; \
                       `\"viscoelastic\"` with `shear_relaxation`, without `bulk_relaxation`; or \
                       `\"elastoplastic\"` with `yield_stress`, with a `saturation` not below the yield stress";
        checker.refuse(path, message, allowed);
    }
}

/// Refuses constants that depend on the temperature in a body whose heat flows.
fn check_heat(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    if !solid.conducts() {
        return;
    }
    let is_of_kernels = matches!(solid.mechanics, Mechanics::Rkpm | Mechanics::Efg);
    let nsni = solid.rkpm.unwrap_or_default().integration == KernelIntegration::Nsni;
    // Values of functions at these points are those of hoop strains, of which temperatures near the axis are not made.
    let fine = !(is_of_kernels && nsni && solid.is_axisymmetric());
    let message = "heat in a meridian section takes other points of kernels than `nsni`";
    let allowed = "`rkpm = { integration = \"scni\" }`; or `mechanics = \"fem\"` or `\"sph\"`";
    checker.require(fine, &path.key("mechanics"), message, allowed);
    let own = solid.material.iter().map(|choice| (path.key("material"), choice.material()));
    let layers = solid.layers.iter().flatten().enumerate();
    let of_layers = layers
        .map(|(n, layer)| (path.key("layers").index(n).key("material"), layer.material.material()));
    for (path, material) in own.chain(of_layers).collect::<Vec<_>>() {
        let heat = &material.heat;
        let of_law = material.law.deformation().properties();
        let curves = [("specific_heat", &heat.specific_heat), ("conductivity", &heat.conductivity)];
        for (key, property) in curves.into_iter().chain(of_law) {
            let fine = property.is_constant() || key == "expansion";
            let message = format!("heat flows in a solid of large strain with one `{key}`");
            checker.require(fine, &path.key(key), message, "a number; `at` of a substance");
        }
        let message = "a solid of large strain does not melt";
        checker.require(heat.melting.is_none(), &path.key("melting"), message, "no `melting`");
    }
}

fn check_faces(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    // What is wrong with the file of a part is reason enough.
    if solid.part().is_some_and(|part| part.body().is_none()) {
        return;
    }
    let is_flat = solid.dimension == 2;
    for (&name, face) in &solid.faces {
        let at = path.key("faces").key(name.as_str());
        let offered: Vec<FaceName> = match solid.plate() {
            Some(shape) => {
                let is_box = solid.is_box();
                let sides = is_box.then_some(FaceName::Sides);
                let own = shape.faces().iter().copied().chain(sides);
                own.filter(|&face| is_there(solid, face)).collect()
            }
            None if solid.part().is_some() => solid.part().map(Part::faces).unwrap_or_default(),
            None if solid.strand().is_some() => {
                vec![FaceName::Left, FaceName::Right, FaceName::Sides]
            }
            None if solid.is_quadrilateral() => {
                FaceName::ALL.into_iter().filter(|&face| is_there(solid, face)).collect()
            }
            None => Vec::new(),
        };
        let names: Vec<&str> = offered.iter().map(|face| face.as_str()).collect();
        let allowed = if names.is_empty() { "no faces".to_owned() } else { names.join(", ") };
        let fine = offered.contains(&name);
        let word = name.as_str();
        let message = match solid.is_box() && is_mirrored(solid, name) {
            true => format!("the model mirrors `{word}`: the face opposite stands for both"),
            false => format!("the shape has no face `{word}` for conditions"),
        };
        if !checker.require(fine, &at, message, allowed) {
            continue;
        }
        let (conditions, thermal) = (face.conditions(), face.heated().thermal());
        let pairs =
            matches!(&conditions[..], [_] | ["roller", "displacement"] | ["pressure", "traction"]);
        let fine = pairs || conditions.is_empty() && !thermal.is_empty();
        let message = "a face has one condition";
        let allowed = "one of clamped, roller, displacement, pressure, traction; or roller with displacement; or pressure \
                       with traction; and one of temperature, flux, convection";
        checker.require(fine, &at, message, allowed);
        let message = "a face has one thermal condition";
        let allowed = "one of temperature, flux, convection";
        checker.require(thermal.len() < 2, &at, message, allowed);
        let is_twice = name.is_one_of_four_sides()
            && solid.has_four_sides()
            && solid
                .faces
                .get(&FaceName::Sides)
                .is_some_and(|sides| !sides.heated().thermal().is_empty());
        let message = "`sides` has a thermal condition for this face, too";
        let allowed = "a thermal condition on `sides` or on this face";
        checker.require(thermal.is_empty() || !is_twice, &at, message, allowed);
        let is_along = match &solid.shape {
            SolidShape::Part(part) if part.is_of_points() => name.normal().is_some(),
            SolidShape::Part(part) => {
                name.normal().is_some_and(|axis| part.axis_of(name) == Some(axis))
            }
            SolidShape::Disc(_) => name != FaceName::Sides || solid.is_axisymmetric(),
            SolidShape::Quadrilateral(own) => own.is_straight(name),
            SolidShape::Strand(own) => own.is_along(name),
            SolidShape::Box(_) | SolidShape::Ball(_) => true,
        };
        let is_of_kernels = matches!(solid.mechanics, Mechanics::Rkpm | Mechanics::Efg);
        let is_held = !face.is_loaded() && !conditions.is_empty() || face.temperature.is_some();
        let may_slip = solid.plate().is_none();
        if is_of_kernels && may_slip && is_held && !is_along {
            let message =
                "kernels hold faces along the axes alone: a slanted one would slip between nodes";
            let allowed = "`mechanics = \"fem\"` or `\"sph\"`, or a load";
            checker.refuse(&at, message, allowed);
        }
        if face.roller && (!is_along || face.displacement.is_some() && name.normal().is_none()) {
            let message = "this face has no normal along an axis";
            checker.refuse(&at.key("roller"), message, "`clamped` or `displacement` alone");
        }
        let drawn =
            solid.load_components(name).into_iter().filter_map(|component| match component {
                LoadComponent::Traction(axis) => Some(axis),
                LoadComponent::Pressure => None,
            });
        prescribed(
            checker,
            &at.key("displacement"),
            face.displacement,
            (&solid.moved_axes(name), is_flat),
        );
        prescribed(
            checker,
            &at.key("traction"),
            face.traction,
            (&drawn.collect::<Vec<_>>(), is_flat),
        );
    }
}

/// Refuses values of a face along axes on which none is prescribed.
fn prescribed(
    checker: &mut Checker,
    path: &Path,
    values: Option<[f64; 3]>,
    (taken, is_flat): (&[usize], bool),
) {
    for axis in (0..3).filter(|axis| !taken.contains(axis)) {
        let message = "nothing is prescribed along this axis";
        let fine = values.is_none_or(|values| values[axis] == 0.0);
        let is_across = is_flat && axis == 1;
        let allowed =
            if is_across { "0, or `dimension = 3`" } else { "0, or `symmetry = \"none\"`" };
        checker.require(fine, &path.index(axis), message, allowed);
    }
}

/// Returns true if a model has a face: a plane one has none across y, and half of a body is cut where the face would
/// be.
fn is_there(solid: &LargeStrain, face: FaceName) -> bool {
    let is_across = matches!(face, FaceName::Front | FaceName::Back);
    let is_flat = is_across && solid.dimension == 2;
    !(is_flat || is_mirrored(solid, face))
}

/// Returns true if the face is the mirror image of the one opposite.
fn is_mirrored(solid: &LargeStrain, face: FaceName) -> bool {
    let [x, y] = solid.mirrors();
    match face {
        FaceName::Left => x,
        FaceName::Front => y,
        _ => false,
    }
}

fn check_explicit(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    for (name, _) in solid.faces.iter().filter(|(_, face)| face.is_held()) {
        let message = "a body that moves explicitly is held by nothing";
        let allowed = "`pressure`, `traction` or thermal conditions; or `motion = \"implicit\"`, or `inertia = false`";
        checker.refuse(&path.key("faces").key(name.as_str()), message, allowed);
    }
}

fn check_implicit(checker: &mut Checker, path: &Path, name: &str, solid: &LargeStrain) {
    let message = "no heat flows in a body that moves implicitly";
    let allowed =
        "no thermal conditions on faces; or `motion = \"explicit\"`, or `inertia = false`";
    checker.require(!solid.conducts(), &path.key("motion"), message, allowed);
    let message = "nothing is below a body that moves implicitly";
    let fine = solid.start.height == 0.0;
    checker.require(fine, &path.at("start.height"), message, "0, or `motion = \"explicit\"`");
    let fine = checker.scene.coupling_from(name).is_none();
    let allowed = "explicit, for a body with a coupling";
    checker.require(fine, &path.key("motion"), message, allowed);
}

fn check_velocity(checker: &mut Checker, path: &Path, solid: &LargeStrain) {
    let [u, v, _] = solid.start.velocity;
    let velocity = path.key("start").key("velocity");
    if solid.is_axisymmetric() && (u != 0.0 || v != 0.0) {
        let message = "a round model does not move sideways";
        checker.refuse(&velocity, message, "[0, 0, VZ], or `symmetry = \"none\"`");
    }
    let [mirrored_x, mirrored_y] = solid.mirrors();
    if mirrored_x && u != 0.0 || mirrored_y && v != 0.0 || solid.dimension == 2 && v != 0.0 {
        let message = "the body moves along an axis that its model lacks or mirrors";
        checker.refuse(&velocity, message, "`symmetry = \"none\"`, `dimension = 3`");
    }
}

fn check_rest(checker: &mut Checker, path: &Path, name: &str, solid: &LargeStrain) {
    if solid.start != LargeStrainStart::default() {
        let message = "a body in equilibrium has no start of its own";
        checker.refuse(&path.key("start"), message, "no `start`, or `inertia = true`");
    }
    let message = "a body in equilibrium takes no time steps";
    checker.require(
        solid.motion.is_none(),
        &path.key("motion"),
        message,
        "no `motion`, or `inertia = true`",
    );
    if checker.scene.coupling_from(name).is_some() {
        let message = "a body in equilibrium does not stand on another";
        checker.refuse(&path.key("inertia"), message, "true, for a body with a coupling");
    }
    let holds = |face: &FaceName, axis: usize| {
        let held = solid.faces[face];
        let along = face.normal() == Some(axis) || (*face == FaceName::Sides && axis < 2);
        let moved = held.displacement.is_some() && !held.roller;
        held.clamped || moved || held.roller && along
    };
    let mut free = Vec::new();
    for (axis, words) in ["x", "y", "z"].into_iter().enumerate() {
        let mirrored = axis < 2 && (solid.is_axisymmetric() || solid.mirrors()[axis]);
        let lacking = axis == 1 && solid.dimension == 2;
        if !mirrored && !lacking && !solid.faces.keys().any(|face| holds(face, axis)) {
            free.push(words);
        }
    }
    let mut message = format!("nothing holds the body along {}", free.join(", "));
    let mut allowed = "`faces.bottom = { clamped = true }`, say; or `inertia = true`";
    if solid.smoothing().is_some() {
        message.push_str(
            ": with `rkpm.smoothing` the whole body is modelled, without planes of symmetry",
        );
        allowed = "`faces.bottom = { clamped = true }`; `roller = true` on a face across each of these axes, such as \
                   `faces.left` for x and `faces.front` for y; or `inertia = true`";
    }
    let mirrors_itself = solid.symmetry == LargeStrainSymmetry::None
        || solid.symmetry == LargeStrainSymmetry::Auto && matches!(solid.shape, SolidShape::Box(_));
    if mirrors_itself && solid.smoothing().is_none() && !free.contains(&"z") {
        allowed = "`symmetry = \"quarter\"`, where the body mirrors itself in x = 0 and y = 0; `faces.bottom = { clamped \
                   = true }`, say; or `inertia = true`";
    }
    checker.require(free.is_empty(), path, message, allowed);
}
