def read_actuators(parts, tree, frames, model):
    return []
