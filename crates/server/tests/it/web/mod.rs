//! The server as a process, spoken to over HTTP.

mod description;
mod example;
mod flows;
mod hidden;
mod hostile;
mod limits;
mod metrics;
mod passwords;
mod people;
mod platforms;
mod removal;
mod replay;
mod roles;
mod storage;
mod suspicion;
mod upgrade;
mod workers;
