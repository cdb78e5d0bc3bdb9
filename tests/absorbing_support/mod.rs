pub struct Pulse;
pub enum Wave {
    A,
}
pub fn returned() {}
