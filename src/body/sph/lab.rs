use super::continuity::*;
use super::loops::*;
use super::momentum::*;
use super::neighbours::*;
use crate::kernel::Kernel;
use std::time::Instant;
pub fn bench() {
    let n: usize = std::env::args().nth(2).map_or(47, |s| s.parse().unwrap());
    let threads: usize = std::env::args().nth(3).map_or(1, |s| s.parse().unwrap());
    let dx = 1.0 / 3.0;
    let mut pts = vec![];
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                let r = |s: usize| ((s as f64 * 0.7548776662466927).fract() - 0.5) * 0.1 * dx;
                let id = (i * n + j) * n + k;
                pts.push([
                    i as f64 * dx + r(id),
                    j as f64 * dx + r(id * 3 + 1),
                    k as f64 * dx + r(id * 7 + 2),
                ]);
            }
        }
    }
    let t = Instant::now();
    let (order, tree) = Neighbours::order(&pts);
    let t1 = t.elapsed().as_secs_f64();
    let pts: Vec<_> = order.iter().map(|&i| pts[i as usize]).collect();
    let t = Instant::now();
    let mut nb = Neighbours::of_ordered(tree, pts.len());
    nb.prepare(&pts, &vec![[0.005, 0.0, 0.0]; pts.len()], 0, threads);
    let t2 = t.elapsed().as_secs_f64();
    let np = pts.len() as f64;
    let listed: usize = nb.blocks.iter().map(|b| b.listed()).sum();
    let src: usize = nb.blocks.iter().map(|b| b.sources.len()).sum();
    println!(
        "N {} sort {:.1} ns list {:.1} ns per particle; listed {:.1}; sources per block {:.0}",
        np,
        t1 / np * 1e9,
        t2 / np * 1e9,
        listed as f64 / np,
        src as f64 / nb.blocks.len() as f64
    );
    let rec: Vec<[f64; 8]> = pts
        .iter()
        .map(|p| [p[0], p[1], p[2], 0.1 * p[0], 0.0, -0.1 * p[2], dx * dx * dx, 0.01])
        .collect();
    let ann: Vec<[f64; 4]> = pts.iter().map(|p| [0.0, 0.0, 0.0, p[0]]).collect();
    let tw = vec![0.0; pts.len()];
    let rr = vec![0.01; pts.len()];
    let s3 = 21.0 / (2.0 * std::f64::consts::PI);
    for rep in 0..3 {
        let c = Continuity {
            records: &rec,
            annexes: &ann,
            wall_temperature: &tw,
            normalisation: s3,
            diffusion: 0.1,
            conduction: 1e-3,
        };
        let t = Instant::now();
        let out = for_all(&c, &nb.blocks, Kernel::WendlandC2, Precision::Single, threads);
        let a = t.elapsed().as_secs_f64();
        let m = Momentum {
            records: &rec,
            densities: &rr,
            normalisation: s3,
            viscosity: 1e-3,
            cohesion: Default::default(),
            wetting: 0.5,
            weight: 0.0,
        };
        let t = Instant::now();
        let o2 = for_all(&m, &nb.blocks, Kernel::WendlandC2, Precision::Single, threads);
        let b = t.elapsed().as_secs_f64();
        let m =
            Momentum { cohesion: super::tension::PairForce::of(1e-3, Kernel::WendlandC2, 3), ..m };
        let t = Instant::now();
        let o3 = for_all(&m, &nb.blocks, Kernel::WendlandC2, Precision::Single, threads);
        let d = t.elapsed().as_secs_f64();
        println!(
            "rep {rep}: continuity+heat {:.1} ns, momentum {:.1} ns, with tension {:.1} ns  -> {:.2} M/s ; {:.2} M/s with tension; {:?} {:?} {:?}",
            a / np * 1e9,
            b / np * 1e9,
            d / np * 1e9,
            1e-6 * np / (a + b),
            1e-6 * np / (a + d),
            out[pts.len() / 2].density,
            o2[pts.len() / 2][0],
            o3[pts.len() / 2][0]
        );
    }
}
use super::*;
pub fn impact() {
    let arg = |n: usize, d: f64| std::env::args().nth(n).map_or(d, |s| s.parse().unwrap());
    let res = arg(2, 20.0);
    let threads = arg(3, 1.0) as usize;
    let sigma = arg(4, 0.0);
    let stop = arg(5, 3.5e-6);
    let quarter = arg(6, 1.0) > 0.0;
    let precision = if arg(7, 0.0) > 0.0 { Precision::Double } else { Precision::Single };
    let placement = if arg(8, 0.0) > 0.0 { Placement::BlueNoise } else { Placement::Lattice };
    let d = 1e-4;
    let dx = d / res;
    let m = if quarter { [true; 2] } else { [false; 2] };
    let plan = DropletPlan {
        dimension: 3,
        spacing: dx,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid: Fluid {
            density: 1000.0,
            viscosity: 3e-4,
            specific_heat: 4000.0,
            conductivity: 0.6,
            surface_tension: sigma,
            sound_speed: 500.0,
        },
        placement,
        precision,
        density_diffusion: 0.1,
        shifting: true,
        gravity: [0.0; 3],
        mirrors: m,
        releases: vec![Release {
            time: 0.0,
            centre: [0.0, 0.0, 0.5 * d + 0.5 * dx],
            diameter: d,
            velocity: [0.0, 0.0, -50.0],
            temperature: 373.15,
        }],
        wall: Some(Wall {
            cells: WallCells::Rings { count: 30, radius: 150e-6 },
            contact_angle: 1.57,
        }),
    };
    let (n, dt) = DropletSph::forecast(&plan);
    println!("forecast {n} particles, dt {dt:.3e}");
    let drop = DropletSph::new(plan, threads);
    let mut s = drop.initial_state();
    let t0 = drop.totals(&s);
    println!("{:?}", t0);
    let wt = vec![309.65; 30];
    let frames = 14;
    let mut work = 0.0;
    for f in 1..=frames {
        let t = Instant::now();
        if let Err(e) = drop.advance(&mut s, &wt, stop / frames as f64) {
            println!("FAILED {e}");
            return;
        }
        let el = t.elapsed().as_secs_f64();
        let q = drop.totals(&s);
        let x = drop.exchange(&s);
        work += q.particles;
        let _ = work;
        println!(
            "t {:.2} us steps {:.0} speed {:.2} M/s wall {:.2}s | KE {:.3} E_c {:.4} mom+imp {:.2e} heat bal {:.2e} | spread {:.3} height {:.3} vmax {:.1} pmax {:.2} MPa rho {:.3}-{:.3} T {:.2}-{:.2} | p0 {:.2} MPa q0 {:.3e} heatwall {:.3e}",
            stop / frames as f64 * f as f64 * 1e6,
            q.steps,
            q.particles * (q.steps) / 1e6 / 1.0_f64,
            el,
            q.kinetic_energy / t0.kinetic_energy,
            q.compression_energy / t0.kinetic_energy,
            (q.momentum[2] + q.impulse_to_wall[2] - t0.momentum[2]) / t0.momentum[2],
            (q.heat + q.heat_to_wall) / (1e-30 + q.heat_to_wall.abs()),
            q.spread_diameter / d,
            q.height / d,
            q.max_speed,
            q.max_pressure / 1e6,
            q.density_range[0],
            q.density_range[1],
            q.temperature_range[0],
            q.temperature_range[1],
            -x.impulse[0][2] / x.duration / (3.14159 * 25e-12) / 1e6,
            x.heat[0] / x.duration / (3.14159 * 25e-12),
            q.heat_to_wall
        );
        if f % 2 == 0 {
            let p = drop.particles(&s);
            let mut o = String::new();
            for i in 0..p.mass.len() {
                o += &format!(
                    "{:e} {:e} {:e} {:e} {:e} {:e}\n",
                    p.position[i][0],
                    p.position[i][1],
                    p.position[i][2],
                    p.velocity[i][2],
                    p.pressure[i],
                    p.temperature[i]
                );
            }
            std::fs::write(format!("/tmp/out/impact{f}.txt"), o).unwrap();
        }
    }
}

fn free(
    dim: usize,
    res: f64,
    radius: f64,
    sigma: f64,
    mu: f64,
    c: f64,
    placement: Placement,
    cohesion_fix: f64,
) -> DropletPlan {
    DropletPlan {
        dimension: dim,
        spacing: 2.0 * radius / res,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid: Fluid {
            density: 1000.0,
            viscosity: mu,
            specific_heat: 4000.0,
            conductivity: 0.6,
            surface_tension: sigma * cohesion_fix,
            sound_speed: c,
        },
        placement,
        precision: Precision::Single,
        density_diffusion: 0.1,
        shifting: true,
        gravity: [0.0; 3],
        mirrors: [true, dim == 3],
        releases: vec![Release {
            time: 0.0,
            centre: [0.0; 3],
            diameter: 2.0 * radius,
            velocity: [0.0; 3],
            temperature: 300.0,
        }],
        wall: None,
    }
}
pub fn laplace() {
    let arg = |n: usize, d: f64| std::env::args().nth(n).map_or(d, |s| s.parse().unwrap());
    let dim = arg(2, 2.0) as usize;
    let res = arg(3, 40.0);
    let cf = arg(4, 15.0);
    let stop = arg(5, 1.0);
    let amp = arg(6, 0.0);
    let pl = if arg(7, 0.0) > 0.0 { Placement::BlueNoise } else { Placement::Lattice };
    let mu = arg(8, 1e-3);
    let shift = arg(9, 1.0) > 0.0;
    let (r, sigma) = (1e-3, 0.0728);
    let uc = (sigma / (1000.0 * r) as f64).sqrt();
    let mut plan = free(dim, res, r, sigma, mu, cf * uc, pl, 1.0);
    plan.shifting = shift;
    let period = if dim == 3 {
        2.0 * 3.14159265 * (1000.0 * r * r * r / (8.0 * sigma) as f64).sqrt()
    } else {
        2.0 * 3.14159265 * (1000.0 * r * r * r / (6.0 * sigma) as f64).sqrt()
    };
    let drop = DropletSph::new(plan, 1);
    let mut s = drop.initial_state();
    if amp != 0.0 {
        let mut p = drop.particles(&s);
        for x in &mut p.position {
            let e = amp;
            if dim == 2 {
                x[0] *= 1.0 + e;
                x[2] /= 1.0 + e;
            } else {
                x[0] /= (1.0 + e).sqrt();
                x[1] /= (1.0 + e).sqrt();
                x[2] *= 1.0 + e;
            }
        }
        s = drop.state_of(&p);
    }
    println!(
        "period {period:.4e} particles {} 2s/R {:.2}",
        drop.totals(&s).particles,
        if dim == 3 { 2.0 * sigma / r } else { sigma / r }
    );
    let frames = arg(10, 40.0) as usize;
    let mut series = vec![];
    for f in 1..=frames {
        if let Err(e) = drop.advance(&mut s, &[], stop * period / frames as f64) {
            println!("FAILED {e}");
            return;
        }
        let p = drop.particles(&s);
        let q = drop.totals(&s);
        let (mut pin, mut n, mut mx, mut mz, mut m, mut pout) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        let mut nout = 0.0;
        for i in 0..p.mass.len() {
            let rr: f64 = p.position[i].iter().map(|x| x * x).sum::<f64>().sqrt();
            if rr < 0.6 * r {
                pin += p.pressure[i];
                n += 1.0;
            }
            if rr > 0.9 * r {
                pout += p.pressure[i];
                nout += 1.0;
            }
            mx += p.mass[i] * p.position[i][0].powi(2);
            mz += p.mass[i] * p.position[i][2].powi(2);
            m += p.mass[i];
        }
        series.push(mx - mz);
        println!(
            "t/T {:.3} steps {} p_in {:.3} p_out {:.3} KE {:.3e} a {:.5e} {:.5e} rho {:.4} {:.4} vmax/uc {:.3}",
            stop * f as f64 / frames as f64,
            q.steps,
            pin / n,
            pout / nout,
            q.kinetic_energy,
            (mx / m).sqrt() / r,
            (mz / m).sqrt() / r,
            q.density_range[0],
            q.density_range[1],
            q.max_speed / uc
        );
    }
}
