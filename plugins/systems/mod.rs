//! Systems: models of machines.

pub mod bouc_wen;
pub mod cascaded_tanks;
pub mod dc_motor;
pub mod duffing;
pub mod mass_spring_damper;
pub mod pid;

pub use bouc_wen::BoucWen;
pub use cascaded_tanks::CascadedTanks;
pub use dc_motor::DcMotor;
pub use duffing::Duffing;
pub use mass_spring_damper::MassSpringDamper;
pub use pid::Pid;
