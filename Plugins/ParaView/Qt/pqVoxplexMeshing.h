// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqVoxplexMeshing
 * @brief   what the plugin adds to ParaView's window besides filters
 *
 * - Abort: ParaView 5.11 shows the button beside its progress bar only while it saves animations, and the button
 *   reaches no filter. While a filter of the plugin executes in ParaView's own process, this shows the
 *   button, lets the window handle events, and stops the filter when the button is pressed. With a
 *   remote server that is not possible: the client then waits for the server.
 * - Names and colours of labels: when a filter of the plugin has made a mesh, or when a source has data that carries them, the colour maps of the arrays
 *   `Label` and `Labels` get them (vtkSMLabelColorsProxy). This happens once for each table of labels, so that what the user
 *   changes in a colour map stays.
 */
#ifndef pqVoxplexMeshing_h
#define pqVoxplexMeshing_h

#include "vtkPVLabelInformation.h"

#include <QObject>

class pqPipelineSource;

class pqVoxplexMeshing : public QObject
{
  Q_OBJECT

public:
  explicit pqVoxplexMeshing(QObject* parent = nullptr);
  ~pqVoxplexMeshing() override = default;

  void startup();
  void shutdown();

private Q_SLOTS:
  void onProgress(const QString& message, int percent);
  void onProgressEnd();
  void onAbort();
  void onDataUpdated(pqPipelineSource* source);

private:
  Q_DISABLE_COPY(pqVoxplexMeshing)

  bool CanAbort = false;
  bool HandlesEvents = false;
  vtkPVLabelInformation::LabelMap Applied; ///< the table of labels that the colour maps got last
};

#endif
