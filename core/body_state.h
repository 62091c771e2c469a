// The motion of one body at one instant, in the scene's own body frame, whatever the formulation that computed it.
#pragma once

#include <Eigen/Core>

namespace poinsot {

struct BodyState {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();      // m, centre of mass, global
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();  // body to global
  Eigen::Vector3d rd = Eigen::Vector3d::Zero();     // m/s, global
  Eigen::Vector3d w = Eigen::Vector3d::Zero();      // rad/s, body frame
  Eigen::Vector3d rdd = Eigen::Vector3d::Zero();    // m/s², global
  Eigen::Vector3d wd = Eigen::Vector3d::Zero();     // rad/s², body frame
};

}  // namespace poinsot
