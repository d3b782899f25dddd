// Attributes of symbols in musl's sources.
#pragma once

#define hidden __attribute__((__visibility__("hidden")))
#define weak_alias(old, new)
