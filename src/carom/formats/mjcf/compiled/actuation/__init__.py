"""`<actuator>`: what drives joints."""
