//! Meshes, particles and costs of bodies.

use std::fmt::Write;

use impinge::model::{Forecast, ParticleForecast};

use super::words::metres;
use crate::units::{engineering, lasting};

/// Describes the cost of each body and the choices made for it, without building it.
pub fn notes(forecast: &Forecast) -> String {
    let mut text = String::new();
    for body in &forecast.bodies {
        let [columns, rows, layers] = body.nodes;
        let [heat, mechanics] = body.unknowns;
        let _ = writeln!(
            text,
            "  {}: {columns} × {rows} × {layers} nodes of order {}, unknowns: heat {heat}, \
             displacement {mechanics}",
            body.name, body.order
        );
        for (axis, [least, most]) in ["x", "y", "z"].iter().zip(body.spacing) {
            if most > 0.0 {
                let (least, most) = (metres(least), metres(most));
                let _ = writeln!(text, "    nodes along {axis}: {least} to {most} apart");
            }
        }
        if let Some(particles) = &body.particles {
            let _ = writeln!(text, "    {}", conduction(particles, columns * rows * layers));
        }
        let step_time = lasting(body.step_time);
        let _ = match body.reduced {
            None => writeln!(
                text,
                "    about {:.0} MB, {} to build, {step_time} a step whose stresses are read",
                body.memory / 1e6,
                lasting(body.build_time)
            ),
            Some(None) => writeln!(
                text,
                "    reduced: about {:.0} MB and {} to get there, then {step_time} a step with all that is read",
                body.memory / 1e6,
                lasting(body.build_time)
            ),
            Some(Some(unknowns)) => writeln!(
                text,
                "    reduced to {unknowns} unknowns of {:.1} kB, {} to get there, about {step_time} a step with all that is read",
                body.memory / 1e3,
                lasting(body.build_time)
            ),
        };
        for note in &body.notes {
            let _ = writeln!(text, "    - {note}");
        }
    }
    for body in &forecast.droplets {
        let _ = match body.particles {
            0 => writeln!(text, "  {}: closed forms", body.name),
            particles => writeln!(
                text,
                "  {}: {particles} particles, about {:.0} time steps of {} and shorter",
                body.name,
                body.steps,
                engineering(body.time_step, "s")
            ),
        };
        cost(&mut text, (body.memory, body.run_time), "steps and exchanges", &body.notes);
    }
    for body in &forecast.large_strains {
        let (nodes, points) = (body.nodes, body.points);
        let _ = match body.time_step {
            Some(step) => writeln!(
                text,
                "  {}: {nodes} nodes, {points} points, about {:.0} time steps of {} and shorter",
                body.name,
                body.steps,
                engineering(step, "s")
            ),
            None => writeln!(
                text,
                "  {}: {nodes} nodes, {points} points, {:.0} steps of equilibrium",
                body.name, body.steps
            ),
        };
        cost(&mut text, (body.memory, body.run_time), "steps", &body.notes);
    }
    for body in &forecast.lattices {
        let _ = match body.time_step {
            Some(step) => writeln!(
                text,
                "  {}: {} particles, about {:.0} time steps of {}",
                body.name,
                body.particles,
                body.steps,
                engineering(step, "s")
            ),
            None => writeln!(text, "  {}: {} unknowns", body.name, body.unknowns),
        };
        cost(&mut text, (body.memory, body.run_time), "steps", &body.notes);
    }
    for body in &forecast.filaments {
        let _ = writeln!(text, "  {}: room for {} {}", body.name, body.count, body.of);
        cost(&mut text, (body.memory, body.run_time), "steps", &body.notes);
    }
    text
}

/// Describes the work of particles in a communication step.
fn conduction(forecast: &ParticleForecast, count: usize) -> String {
    let ParticleForecast { neighbours, sub_steps, products, euler_steps } = forecast;
    let parts = if *sub_steps == 1 { "sub-step" } else { "sub-steps" };
    format!(
        "heat: {count} particles of {neighbours} neighbours; about {sub_steps} {parts} of {products} \
         products a communication step, where explicit Euler steps would need {euler_steps}"
    )
}

/// Adds the memory [B] and time [s] of a body, and the notes on it.
fn cost(text: &mut String, (memory, time): (f64, f64), what: &str, notes: &[String]) {
    let (memory, time) = (memory / 1e6, lasting(time));
    let _ = writeln!(text, "    about {memory:.0} MB, {time} for all its {what}");
    for note in notes {
        let _ = writeln!(text, "    - {note}");
    }
}
