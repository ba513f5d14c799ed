//! Time: worlds, agents, sensors, tasks, batches; joins the engines.
