// Changing how links touch, and how bodies are damped: a kernel of quick calls.

#include "export.h"
#include "quick_calls.h"

namespace {

// Places of the arguments of `changeDynamics`, vectors taking three.
enum {
    LINK = 1,
    LATERAL_FRICTION = 3,
    SPINNING_FRICTION,
    ROLLING_FRICTION,
    RESTITUTION,
    LINEAR_DAMPING,
    ANGULAR_DAMPING,
    CONTACT_STIFFNESS,
    CONTACT_DAMPING,
    LOWER_LIMIT = 24,
    SLEEP_THRESHOLD = 27,
};

// In the order of `Scene::surface` and `Scene::damping`.
const int OF_SURFACE[] = {
    LATERAL_FRICTION, SPINNING_FRICTION, ROLLING_FRICTION, RESTITUTION, CONTACT_STIFFNESS, CONTACT_DAMPING,
};
const int OF_BODY[] = {LINEAR_DAMPING, ANGULAR_DAMPING};

// Whether an argument other than those above is what it is by default.
bool is_left_out(const double* in, int place) {
    return in[place] != in[place] || in[place] == (place == LOWER_LIMIT ? 1.0 : -1.0);
}

bool has_others(const double* in) {
    for (int place = LINK + 1; place <= SLEEP_THRESHOLD; ++place)
        if ((place < LATERAL_FRICTION || place > CONTACT_DAMPING) && !is_left_out(in, place))
            return true;
    return false;
}

// Whether one of some arguments is given.
template <int count>
bool has_one(const double* in, const int (&places)[count]) {
    for (int place : places)
        if (in[place] >= 0.0)
            return true;
    return false;
}

// Lets the host know of a number that it keeps as well.
bool tell(PyObject* dynamics, PyObject* name, double number) {
    PyObject* value = python.PyFloat_FromDouble(number);
    const bool well = value && !python.PyObject_SetAttr(dynamics, name, value);
    if (value)
        python.Py_DecRef(value);
    if (!well)
        python.PyErr_Clear();
    return well;
}

}  // namespace

// The arguments of `changeDynamics`. Python sees to all but friction, restitution, softness and damping, and to calls
// that mix what belongs to a link with what belongs to the body.
extern "C" CAROM_EXPORT int carom_change_surface(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    const Scene& scene = *call->client->scene;
    const bool of_surface = has_one(in, OF_SURFACE), of_body = has_one(in, OF_BODY);
    if (has_others(in) || (of_surface && of_body) || !(-1.0 <= in[LINK] && in[LINK] < body.link_count))
        return 0;
    if ((in[CONTACT_STIFFNESS] >= 0.0) != (in[CONTACT_DAMPING] >= 0.0))
        return 0;
    const Lock lock(*call->client);
    if (!lock.is_held || !scene.find_poses.function)
        return 0;
    if (of_body)
        for (int i = 0; i < 2; ++i)
            if (in[OF_BODY[i]] >= 0.0)
                scene.damping[i][body.tree] = in[OF_BODY[i]];
    if (of_surface) {
        const int64_t link = static_cast<int64_t>(in[LINK]);
        PyObject* dynamics = python.PyList_GetItem(body.dynamics, link + 1);
        for (int i = 0; i < 6; ++i)
            if (in[OF_SURFACE[i]] >= 0.0) {
                if (!tell(dynamics, scene.surface_names[i], in[OF_SURFACE[i]]))
                    return 0;
                scene.surface[i][body.first_link + link + 1] = in[OF_SURFACE[i]];
            }
    }
    return 1;
}
