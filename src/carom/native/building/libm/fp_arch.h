// No platform has operations of its own: musl's generic ones are used everywhere.
#pragma once
