// No platform-specific operations: musl's generic ones are used everywhere.
#pragma once
