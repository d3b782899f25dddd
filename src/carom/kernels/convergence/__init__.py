"""What makes the sweeps over an island's rows converge sooner."""
