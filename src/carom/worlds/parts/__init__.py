"""The parts of a body in many worlds: its joints, links, shapes, actuators, sensors and sites."""
