// Quick calls that find contacts, and list them as Python tuples.

#include "export.h"
#include "quick_calls.h"
#include "rows.h"

namespace {

// Larger numbers of contacts are left to Python, which lets other threads run meanwhile.
enum { MAX_CONTACTS = 64 };

Contact contact_at(const ContactColumns& found, int32_t i) {
    return {
        found.body_a[i],
        found.body_b[i],
        found.link_a[i],
        found.link_b[i],
        vector_at(found.point_a + 3 * i),
        vector_at(found.point_b + 3 * i),
        vector_at(found.normal + 3 * i),
        vector_at(found.direction1 + 3 * i),
        vector_at(found.direction2 + 3 * i),
        found.distance[i],
        found.force[i],
        found.force1[i],
        found.force2[i]
    };
}

}  // namespace

// Arguments: first body, second body, link of the first, link of the second, connection.
extern "C" CAROM_EXPORT PyObject* carom_contact_points(const double* in, const Call* call) {
    const ContactLister& report = call->client->scene->report;
    if (!report.call.function || *report.there > MAX_CONTACTS)
        return nullptr;
    if (*report.there > report.room || report.there[contacts::OVERLAPS] > report.room)
        return nullptr;
    if (!*report.there)
        return python.PyTuple_New(0);
    {
        const TemporaryValue<int32_t> count(report.asked.count, *report.there);
        const TemporaryValue<int32_t> body_a(report.asked.body_a, static_cast<int32_t>(in[0]));
        const TemporaryValue<int32_t> body_b(report.asked.body_b, static_cast<int32_t>(in[1]));
        const TemporaryValue<int32_t> link_a(report.asked.link_a, static_cast<int32_t>(in[2]));
        const TemporaryValue<int32_t> link_b(report.asked.link_b, static_cast<int32_t>(in[3]));
        const TemporaryValue<double> time_step(report.asked.time_step, call->client->time_step);
        run(report.call);
    }
    const int32_t found = *report.found.count;
    Contact contacts[MAX_CONTACTS];
    for (int32_t i = 0; i < found; ++i)
        contacts[i] = contact_at(report.found, i);
    // From here on the report may be gone: making a tuple can start garbage collection, which may run any code.
    Row rows(found);
    for (int32_t i = 0; rows.tuple && i < found; ++i)
        rows.add(tuple_of(contacts[i]));
    return rows.tuple;
}

// Arguments: connection.
extern "C" CAROM_EXPORT int carom_detect_collisions(const double*, double*, const Call* call) {
    const Detection& detection = call->client->scene->detection;
    const Lock lock(*call->client);
    if (!lock.is_held || !detection.run)
        return 0;
    const uint64_t bytes = detection.pose_count * sizeof(double);
    // Detection starts from the present poses. After a step the others are those at the start of its last substep,
    // which other functions have to return.
    __builtin_memcpy(detection.poses_before, detection.poses, bytes);
    run(detection.find_poses);
    carom_perform(detection.run);
    __builtin_memcpy(detection.poses, detection.poses_before, bytes);
    return *detection.status == 0;
}
