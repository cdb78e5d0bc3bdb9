mod common;
use whipple::comm::Comm;
use whipple::step::Simulation;
#[test]
fn try_it() {
    let comm = Comm::solo();
    let dp: f64 = std::env::var("DP").map_or(0.04e-3, |s| s.parse().unwrap());
    let mut case = common::sphere_on_plate(dp, 7000.0, true, 0.2e-6);
    if std::env::var("VARH").is_ok() { case.sph.smoothing_length = whipple::model::SmoothingLength::Variable{min:0.6,max:2.0}; }
    if std::env::var("SPALL").is_ok() { case.materials[0].spall = Some(whipple::material::Spall{pressure:-1.2e9}); }
    let mut sim = Simulation::start(case, &comm).unwrap();
    println!("particles {} capped {} touching {:?}", sim.store.owned(), sim.state.capped_reliefs, sim.contact().pair(0,1));
    let t = std::time::Instant::now();
    while !sim.is_finished() {
        sim.advance(&comm).unwrap();
        if sim.state.step % 50 == 0 || sim.is_finished() {
            sim.diagnose(&comm);
            let s=&sim.state;
            println!("{} t={:.4e} dt={:.3e} {:?} KE {:.6e} IE {:.6e} PHI {:.3e} err {:.3e} work {:.3e} defect {:.2e} mom {:?} err {:.1e?} inter {} closest {:?} frac {:.3}", s.step,s.time,s.last_dt,s.last_reason,s.totals.kinetic_energy,s.totals.internal_energy,s.contact_energy,s.worst.energy_error,s.contact_work,s.worst.contact_defect,s.totals.momentum,s.worst.momentum_error,s.worst.interpenetrated,s.worst.closest,s.worst.foreign_fraction);
        }
    }
    let e=t.elapsed().as_secs_f64();
    println!("{e} s, {} updates/s/core(1 rank)", sim.updates as f64/e);
    for (n,s) in sim.timers.report() { println!("{n} {:.1}%", s/e*100.0); }
    println!("bytes/particle {}", sim.memory()/sim.store.owned());
}
