//! Record of each image that the search and the sums over pairs read.

/// Record of the motion of a particle that its neighbours read: one cache line.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub struct MotionRecord {
    /// Position (m).
    pub position: [f64; 3],
    /// Volume m/ρ (m^d).
    pub volume: f64,
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Mass (kg).
    pub mass: f64,
}
