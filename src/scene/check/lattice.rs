//! Checks size, notch, support, control and softening of each lattice.

use super::{Checker, fits, number};
use crate::laws::fracture::{SofteningKeys, SofteningModel};
use crate::scene::lattice::{Lattice, LatticeControl, LatticeNotch, LatticeSupport};
use crate::scene::locate::Path;

/// Least number of particles over the depth.
const LEAST_LAYERS: f64 = 4.0;
/// Least length over the spacing.
const LEAST_ALONG: f64 = 3.0;
/// Least depth below the load of a bent strip, over the spacing: links within two spacings of the load stay intact, and
/// a narrower rest bends like a hinge that does not break.
const LEAST_LIGAMENT: f64 = 5.0;

pub fn check(checker: &mut Checker) {
    for (name, lattice) in checker.scene.lattices() {
        let path = Path::default().key("body").key(name);
        softening(checker, &path.at("material.softening"), &lattice.material.softening);
        if checker.is_fine(&path) {
            spacing(checker, &path, lattice);
        }
        if checker.is_fine(&path) {
            notch(checker, &path, lattice);
            support(checker, &path, lattice);
        }
        let needs = lattice.control == LatticeControl::Opening && lattice.notch.is_none();
        let message = "without a notch there is no opening to prescribe";
        checker.require(!needs, &path.key("control"), message, "\"displacement\", or a `notch`");
        inertia(checker, &path, lattice);
    }
}

/// A load that moves is no opening that follows, and damping is that of motion.
fn inertia(checker: &mut Checker, path: &Path, lattice: &Lattice) {
    let follows = lattice.inertia && lattice.control == LatticeControl::Opening;
    let message = "of a strip with inertia the load moves, and the opening follows";
    let allowed = "\"displacement\", or `inertia = false`";
    checker.require(!follows, &path.key("control"), message, allowed);
    let rests = lattice.damping > 0.0 && !lattice.inertia;
    let message = "a strip without inertia has no speed to damp";
    checker.require(!rests, &path.key("damping"), message, "0, or `inertia = true`");
}

/// Requires the keys of the chosen model, and refuses those of the other.
fn softening(checker: &mut Checker, path: &Path, keys: &SofteningKeys) {
    let [openings, stretches] = [
        [("strength", keys.strength.is_some()), ("openings", keys.openings.is_some())],
        [("onset", keys.onset.is_some()), ("stretches", keys.stretches.is_some())],
    ];
    let (name, needed, foreign, range) = match keys.model {
        SofteningModel::Openings => ("openings", openings, stretches, ("openings", keys.openings)),
        SofteningModel::Stretches => {
            ("stretches", stretches, openings, ("stretches", keys.stretches))
        }
    };
    for (key, _) in needed.iter().filter(|(_, is_there)| !is_there) {
        let message = format!("softening over {name} needs `{key}`");
        let allowed = format!("`{}` and `{}`", needed[0].0, needed[1].0);
        checker.refuse(&path.key(key), message, allowed);
    }
    for (key, _) in foreign.iter().filter(|(_, is_there)| *is_there) {
        let message = format!("softening over {name} has no `{key}`");
        let allowed = format!("`{}` and `{}`", needed[0].0, needed[1].0);
        checker.refuse(&path.key(key), message, allowed);
    }
    if let (key, Some([knee, end])) = range {
        let message = "the knee is not before the end";
        checker.require(
            knee < end,
            &path.key(key),
            message,
            format!("the second above {}", number(knee)),
        );
    }
}

fn spacing(checker: &mut Checker, path: &Path, lattice: &Lattice) {
    let most = lattice.depth / LEAST_LAYERS;
    let message = "particles so far apart resolve no bending";
    let path = path.key("spacing");
    checker.require(fits(lattice.spacing, most), &path, message, format!("up to {}", number(most)));
    let most = lattice.length / LEAST_ALONG;
    let message = "a strip of this length has fewer than three particles along it";
    checker.require(fits(lattice.spacing, most), &path, message, format!("up to {}", number(most)));
    let (count, least) = (lattice.particles(), lattice.least_spacing());
    let message = format!("{} particles would fill the strip", number(count.ceil()));
    checker.require(
        count <= Lattice::MOST_PARTICLES,
        &path,
        message,
        format!(">= {}", number(least)),
    );
}

fn notch(checker: &mut Checker, path: &Path, lattice: &Lattice) {
    let Some(notch) = lattice.notch else { return };
    let path = path.key("notch");
    let (rows, why) = match lattice.support {
        LatticeSupport::Ends => (2.0, ""),
        LatticeSupport::ThreePoint(_) => {
            (LEAST_LIGAMENT, ", as links within two spacings of the load stay intact")
        }
    };
    let most = lattice.depth - rows * lattice.spacing;
    let message = format!("the notch leaves too little of the depth{why}");
    let allowed = match most > 0.0 {
        true => format!("up to {}, or a smaller `spacing`", number(most)),
        false => "a smaller `spacing`".to_owned(),
    };
    checker.require(fits(notch.depth, most), &path.key("depth"), message, allowed);
    let message = "the notch is shallower than particles are apart";
    let allowed = format!(">= {}, or a smaller `spacing`", number(lattice.spacing));
    checker.require(fits(lattice.spacing, notch.depth), &path.key("depth"), message, allowed);
    let reach = 0.5 * lattice.length - 2.0 * lattice.spacing - 0.5 * notch.width;
    place(checker, &path, (notch, reach), "the notch reaches beyond the strip", "length");
}

/// Requires a notch near enough to the middle [m], or refuses its width where there is room for none.
fn place(
    checker: &mut Checker,
    path: &Path,
    (notch, reach): (LatticeNotch, f64),
    message: &str,
    longer: &str,
) {
    if reach >= 0.0 {
        let allowed = format!("between {} and {}", number(-reach), number(reach));
        checker.require(fits(notch.at.abs(), reach), &path.key("at"), message, allowed);
        return;
    }
    let most = notch.width + 2.0 * reach;
    let narrower = if most < 0.0 { String::new() } else { format!("up to {}, or ", number(most)) };
    let message = "there is no room for the notch with links at both sides";
    let allowed = format!("{narrower}more `{longer}`, or a smaller `spacing`");
    checker.refuse(&path.key("width"), message, allowed);
}

fn support(checker: &mut Checker, path: &Path, lattice: &Lattice) {
    let LatticeSupport::ThreePoint(own) = lattice.support else { return };
    let least = lattice.depth / LEAST_LIGAMENT;
    let message =
        "links within two spacings of the load stay intact, and too little of the depth is left";
    let allowed = format!("up to {}", number(least));
    checker.require(fits(lattice.spacing, least), &path.key("spacing"), message, allowed);
    let (body, path) = (path, path.at("support.three_point.span"));
    // Nearer to the ends a support has no particles on both sides, and the strip is a tenth too soft.
    let most = lattice.length - 2.0 * lattice.spacing;
    let message = "the supports are less than a spacing from the ends of the strip";
    let allowed = format!("up to {}, or more `length`", number(most));
    checker.require(fits(own.span, most), &path, message, allowed);
    let least = 8.0 * lattice.spacing;
    let message = "links near supports and load stay intact, and nothing is left between them";
    checker.require(fits(least, own.span), &path, message, format!(">= {}", number(least)));
    let notch = lattice.notch.filter(|_| checker.is_fine(&body.key("notch")));
    if let Some(notch) = notch {
        let reach = 0.5 * own.span - 0.5 * notch.width - 3.0 * lattice.spacing;
        place(checker, &body.key("notch"), (notch, reach), "the notch is at a support", "span");
    }
}
