#pragma once
/// Whether a pass drew anything: an any-samples-passed query.

#include "graph/Device.h"

namespace lucent::gl {

class Device;

/// Given to a pass (PassBuilder::query), polled in later frames. WebGL2 counts no samples: any, or none.
class Query : public graph::Query {
public:
    /// @param device  outlives the query
    explicit Query(const Device& device);
    ~Query() override;
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;

    std::optional<bool> poll() override;

private:
    friend class Device;
    void begin();
    void end();
    const Device& device_;
    unsigned id_ = 0;
    bool asked_ = false;
    int polls_ = 0; // since the pass
    std::optional<bool> answer_;
};

} // namespace lucent::gl
