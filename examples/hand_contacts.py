"""Close a hand around a ball and say which finger presses how hard."""

import carom
from carom.examples import robot_file

world = carom.World()
world.load(robot_file("hand.xml"))
world.controls = [0.3, 0.5] * 3
world.step(500)
for contact in world.contacts("palm", "ball"):
    print(contact.a.name, contact.position, contact.force)
print(world.force_between("palm", "ball"))
