// What musl's sources say of names.
#pragma once

#define hidden __attribute__((__visibility__("hidden")))
#define weak_alias(old, new)
