"""The step, one file per stage, as Warp kernels; and the parameters of the engine."""
